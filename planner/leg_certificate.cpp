#include "planner/leg_certificate.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include "core/check.hpp"
#include "model/gravity.hpp"
#include "model/motor.hpp"

namespace hopscotch::planner {

namespace {

using core::Joint;

constexpr std::string_view kSideMotors = "hip roll and yaw motors";
constexpr std::string_view kFootLoad = "lighter foot's load";

/// Lines of the planar certificate that speak of one motor.
struct MotorLines {
  std::string_view torque = kSideMotors;
  std::string_view line = kSideMotors;
  std::string_view power = kSideMotors;
  std::string_view speed = kSideMotors;
  std::string_view range = kSideMotors;
};
constexpr std::array<MotorLines, core::kJointsPerLeg> kMotorLines{
    {{},
     {},
     {"hip torque", "hip torque-speed line", "hip power", "hip speed", "hip range"},
     {"knee torque", "knee torque-speed line", "knee power", "knee speed", "knee range"},
     {"ankle torque", "ankle torque-speed line", "ankle power", "ankle speed", "ankle range"}}};

class LegExaminer {
 public:
  LegExaminer(const model::RobotParameters& robot, double friction, core::JumpPlan& plan)
      : robot_(robot), friction_(friction), plan_(plan) {}

  void examine(const core::JumpKnot& knot, const core::JumpKnot& next) {
    for (const core::Leg leg : core::kAllLegs) {
      const int first = core::leg_offset(leg);
      const core::LegVector torque =
          model::motor_torques(knot.tau.segment<core::kJointsPerLeg>(first));
      examine_motors(torque, knot, first);
      if (next.phase == knot.phase) examine_motors(torque, next, first);  // no rates after impact
      examine_ranges(leg, knot.q.segment<core::kJointsPerLeg>(first), knot.time);
      if (knot.contact[core::index(leg)]) examine_foot(knot.wrenches[core::index(leg)], knot.time);
    }
  }

 private:
  void note(std::string_view name, double margin, double time) {
    core::Certificate& certificate = plan_.certificate;
    const auto end = certificate.entries.begin() + static_cast<std::ptrdiff_t>(certificate.count);
    const auto entry = std::find_if(certificate.entries.begin(), end,
                                    [&](const auto& each) { return each.name == name; });
    if (entry == end) {
      HOPSCOTCH_CHECK(certificate.count < core::Certificate::kMaxEntries);
      certificate.entries[certificate.count++] = {name, margin, time};
    } else if (margin < entry->margin) {
      *entry = {name, margin, time};
    }
    certificate.dense_max_violation = std::max(certificate.dense_max_violation, -margin);
  }

  void examine_motors(const core::LegVector& torque, const core::JumpKnot& at_knot, int first) {
    const core::LegVector speed =
        model::motor_speeds(at_knot.dq.segment<core::kJointsPerLeg>(first));
    const double time = at_knot.time;
    for (std::size_t i = 0; i < kMotorLines.size(); ++i) {
      const model::MotorParameters& motor = robot_.motors[i];
      const MotorLines& lines = kMotorLines[i];
      const auto at = static_cast<Eigen::Index>(i);
      const double torque_ratio = std::abs(torque(at)) / motor.torque_max;
      const double speed_ratio = std::abs(speed(at)) / motor.speed_max;
      const double power_ratio = std::max(0.0, torque(at) * speed(at)) / robot_.motor_power_max;
      note(lines.torque, 1.0 - torque_ratio, time);
      note(lines.speed, 1.0 - speed_ratio, time);
      note(lines.power, 1.0 - power_ratio, time);
      if (torque(at) * speed(at) > 0.0) {
        const double bend = (motor.speed_max - motor.corner_speed) / motor.speed_max;
        note(lines.line, 1.0 - bend * torque_ratio - speed_ratio, time);
      }
      plan_.peaks.torque_ratio = std::max(plan_.peaks.torque_ratio, torque_ratio);
      plan_.peaks.speed_ratio = std::max(plan_.peaks.speed_ratio, speed_ratio);
      plan_.peaks.power_ratio = std::max(plan_.peaks.power_ratio, power_ratio);
    }
  }

  void examine_ranges(core::Leg leg, const core::LegVector& q, double time) {
    for (std::size_t i = 0; i < kMotorLines.size(); ++i) {
      const model::JointRange range = model::joint_range(robot_, leg, static_cast<Joint>(i));
      const double angle = q(static_cast<Eigen::Index>(i));
      const double distance = std::min(angle - range.lower, range.upper - angle);
      note(kMotorLines[i].range, distance / (0.5 * (range.upper - range.lower)), time);
    }
  }

  void examine_foot(const core::Wrench& wrench, double time) {
    const double weight = robot_.total_mass() * model::kGravity;
    const double load = wrench.force.z();
    note(kFootLoad, load / (0.5 * weight), time);
    if (load <= 0.0) return;
    note("friction", 1.0 - wrench.force.head<2>().norm() / (friction_ * load), time);
  }

  const model::RobotParameters& robot_;
  double friction_;
  core::JumpPlan& plan_;
};

}  // namespace

void certify_legs(const model::RobotParameters& robot, double friction, core::JumpPlan& plan) {
  LegExaminer examiner(robot, friction, plan);
  for (std::size_t i = 0; i + 1 < plan.knot_count; ++i) {
    examiner.examine(plan.knots[i], plan.knots[i + 1]);
  }
}

}  // namespace hopscotch::planner
