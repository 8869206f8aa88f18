#include "planner/certificate.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "planner/flight_phase.hpp"
#include "planner/forward_dynamics.hpp"
#include "planner/shared_limits.hpp"

namespace hopscotch::planner {

namespace {

using model::LinkArray;

constexpr double kGrid = 1e-3;       // [s]
constexpr double kFlightEnds = 0.2;  // share of the flight near the ground at either end
/// The smooth terrain lies above what was seen, most of all beside edges: a point of the leg may be
/// so far below it without touching the ground [m].
constexpr double kTerrainAllowance = 12e-3;

// Checks by number; those of motors and joints run hip, knee, ankle.
constexpr std::size_t kHipTorque = 0;
constexpr std::size_t kHipLine = 3;
constexpr std::size_t kHipPower = 6;
constexpr std::size_t kHipSpeed = 9;
constexpr std::size_t kHipRange = 12;
constexpr std::size_t kNormalForce = 15;
constexpr std::size_t kFriction = 16;
constexpr std::size_t kToePressure = 17;
constexpr std::size_t kHeelPressure = 18;
constexpr std::size_t kToeClearance = 19;
constexpr std::size_t kHeelClearance = 20;
constexpr std::size_t kKneeClearance = 21;
constexpr std::size_t kShankClearance = 22;
constexpr std::size_t kChecks = 23;
constexpr std::array<std::string_view, kChecks> kNames{"hip torque",
                                                       "knee torque",
                                                       "ankle torque",
                                                       "hip torque-speed line",
                                                       "knee torque-speed line",
                                                       "ankle torque-speed line",
                                                       "hip power",
                                                       "knee power",
                                                       "ankle power",
                                                       "hip speed",
                                                       "knee speed",
                                                       "ankle speed",
                                                       "hip range",
                                                       "knee range",
                                                       "ankle range",
                                                       "normal force",
                                                       "friction",
                                                       "toe pressure",
                                                       "heel pressure",
                                                       "toe clearance",
                                                       "heel clearance",
                                                       "knee clearance",
                                                       "shank clearance"};
static_assert(kChecks <= core::Certificate::kMaxEntries);
/// Of the points that ClearanceLaw looks at.
constexpr std::array<std::size_t, ClearanceLaw::kRowCount> kClearanceChecks{
    kToeClearance, kHeelClearance, kShankClearance, kShankClearance, kKneeClearance};

/// Collects the smallest margin of each check and the peaks.
class Examiner {
 public:
  Examiner(const PlanarModel& model, const PlanarTask& task, const PlanarMotion& motion)
      : model_(model),
        task_(task),
        motion_(motion),
        limits_(motor_limits(model.robot, Reserves{1.0, 1.0, 1.0, 1.0})) {
    margin_.fill(std::numeric_limits<double>::infinity());
    time_.fill(core::kNaN);
  }

  void examine(const PlanarInstant& now, double time) {
    examine_motors(now, time);
    examine_ranges(now, time);
    if (now.phase == core::JumpPhase::flight) {
      examine_clearance(now, time);
    } else {
      examine_ground(now, time);
      if (now.phase == core::JumpPhase::landing) examine_landed_shank(now, time);
    }
  }

  void note_violation(double size) { violation_ = std::max(violation_, size); }

  [[nodiscard]] CertifiedMotion result() const {
    CertifiedMotion out;
    double violation = violation_;
    for (std::size_t i = 0; i < kChecks; ++i) {
      out.certificate.entries[i] = {kNames[i], margin_[i], time_[i]};
      violation = std::max(violation, -margin_[i]);
    }
    out.certificate.count = kChecks;
    out.certificate.dense_max_violation = violation;
    out.peaks = peaks_;
    return out;
  }

 private:
  void note(std::size_t check, double margin, double time) {
    if (margin_[check] <= margin) return;
    margin_[check] = margin;
    time_[check] = time;
  }

  void examine_motors(const PlanarInstant& now, double time) {
    const model::PlanarJoints<double> torque = model::motor_torques_from_joints(now.tau);
    const model::PlanarJoints<double> speed = model::motor_rates_from_links(now.links.rate);
    examine_motor(0, limits_.hip, torque.hip, speed.hip, time);
    examine_motor(1, limits_.knee, torque.knee, speed.knee, time);
    examine_motor(2, limits_.ankle, torque.ankle, speed.ankle, time);
  }

  void examine_motor(std::size_t motor, const MotorLimit& limit, double torque, double speed,
                     double time) {
    const double torque_ratio = std::abs(torque) / limit.torque;
    const double speed_ratio = std::abs(speed) / limit.speed;
    const double power_ratio = std::max(0.0, torque * speed) / limit.power;
    note(kHipTorque + motor, 1.0 - torque_ratio, time);
    note(kHipSpeed + motor, 1.0 - speed_ratio, time);
    note(kHipPower + motor, 1.0 - power_ratio, time);
    if (torque * speed > 0.0) {
      const double line =
          torque_ratio * (limit.speed - limit.corner_speed) / limit.speed + speed_ratio;
      note(kHipLine + motor, 1.0 - line, time);
    }
    peaks_.torque_ratio = std::max(peaks_.torque_ratio, torque_ratio);
    peaks_.speed_ratio = std::max(peaks_.speed_ratio, speed_ratio);
    peaks_.power_ratio = std::max(peaks_.power_ratio, power_ratio);
  }

  void examine_ranges(const PlanarInstant& now, double time) {
    const model::PlanarJoints<double> q = model::joints_from_links(now.links.pitch);
    const std::array<std::pair<core::Joint, double>, 3> joints{{{core::Joint::hip_pitch, q.hip},
                                                                {core::Joint::knee, q.knee},
                                                                {core::Joint::ankle, q.ankle}}};
    for (std::size_t i = 0; i < joints.size(); ++i) {
      const model::JointRange range =
          model::joint_range(model_.robot, core::Leg::left, joints[i].first);
      const double angle = joints[i].second;
      const double distance = std::min(angle - range.lower, range.upper - angle);
      note(kHipRange + i, distance / (0.5 * (range.upper - range.lower)), time);
    }
  }

  void examine_ground(const PlanarInstant& now, double time) {
    const model::PlanarChain& chain = model_.dynamics.chain();
    const double fz = now.force.z;
    note(kNormalForce, fz / (chain.total_mass() * model::kGravity), time);
    peaks_.normal_force = std::max(peaks_.normal_force, fz);
    if (fz <= 0.0) return;
    note(kFriction, 1.0 - std::abs(now.force.x) / (kFrictionShareMax * model_.config.friction * fz),
         time);
    const double pressure = -(now.moment + chain.sole_height * now.force.x) / fz;
    note(kToePressure, (chain.toe - pressure) / chain.toe, time);
    note(kHeelPressure, (chain.heel + pressure) / chain.heel, time);
  }

  void examine_clearance(const PlanarInstant& now, double time) {
    const double share =
        (time - motion_.liftoff_time) / (motion_.touchdown_time - motion_.liftoff_time);
    const bool in_the_middle = share >= kFlightEnds && share <= 1.0 - kFlightEnds;
    const double allowance = in_the_middle ? 0.0 : kTerrainAllowance;
    const auto points = ClearanceLaw::points(model_.dynamics, now.links.pitch);
    for (std::size_t p = 0; p < points.size(); ++p) {
      const double radius = p < ClearanceLaw::kFootRows
                                ? 0.0
                                : model_.robot.shank_radius + ClearanceLaw::kShankAllowance;
      note_clearance(kClearanceChecks[p],
                     above(now, points[p], ClearanceLaw::look_back(p)) - radius, allowance, time);
    }
  }

  /// The landing leans the shanks back over what was jumped down from.
  void examine_landed_shank(const PlanarInstant& now, double time) {
    const double room = shank_room(model_, task_.terrain, now.ankle, now.links.pitch[model::kShank],
                                   model_.robot.shank_radius);
    note(kShankClearance, room / model_.config.clearance, time);
  }

  /// Where the soles leave and meet the ground only what is below it counts.
  void note_clearance(std::size_t check, double height, double allowance, double time) {
    if (allowance > 0.0 && height >= -allowance) return;
    note(check, (height + allowance) / model_.config.clearance, time);
  }

  [[nodiscard]] double above(const PlanarInstant& now,
                             const model::PlanarVector<double>& from_ankle,
                             double look_back) const {
    const double x = now.ankle.x + from_ankle.x - look_back;
    return now.ankle.z + from_ankle.z - task_.terrain.at(x).height;
  }

  const PlanarModel& model_;
  const PlanarTask& task_;
  const PlanarMotion& motion_;
  MotorLimits limits_;
  std::array<double, kChecks> margin_{};
  std::array<double, kChecks> time_{};
  double violation_ = 0.0;
  core::PlanPeaks peaks_{0.0, 0.0, 0.0, 0.0};
};

/// A step with torques that are held.
struct HeldStep {
  const model::PlanarDynamics& dynamics;
  core::JumpPhase phase;
  model::PlanarJoints<double> tau;

  [[nodiscard]] LinkArray<double> acceleration(const LinkState& links) const {
    return phase == core::JumpPhase::flight ? flight_acceleration(dynamics, links, tau)
                                            : stance_acceleration(dynamics, links, tau);
  }
  /// Mean acceleration over the first `h` by Heun's rule.
  [[nodiscard]] LinkArray<double> first_mean(const LinkState& links, const LinkArray<double>& now,
                                             double h) const {
    return mean(now, acceleration(advanced(links, now, h)), 0.5);
  }
  /// The rule of Adams and Bashforth with two points.
  [[nodiscard]] static LinkArray<double> next_mean(const LinkArray<double>& now,
                                                   const LinkArray<double>& before) {
    return mean(now, before, -0.5);
  }
  [[nodiscard]] static LinkState advanced(LinkState links, const LinkArray<double>& u, double h) {
    for (std::size_t j = 0; j < model::kPlanarLinks; ++j) {
      links.pitch[j] += h * (links.rate[j] + 0.5 * h * u[j]);
      links.rate[j] += h * u[j];
    }
    return links;
  }

 private:
  static LinkArray<double> mean(const LinkArray<double>& a, const LinkArray<double>& b,
                                double share) {
    LinkArray<double> out;
    for (std::size_t j = 0; j < out.size(); ++j) out[j] = (1.0 - share) * a[j] + share * b[j];
    return out;
  }
};

double largest_speed(const model::RobotParameters& robot) {
  double speed = 0.0;
  for (const model::MotorParameters& motor : robot.motors) speed = std::max(speed, motor.speed_max);
  return speed;
}

/// Distance between the integrated and the planned end of a step.
double mismatch(const LinkState& reached, const LinkState& planned, double speed_max) {
  double error = 0.0;
  for (std::size_t j = 0; j < model::kPlanarLinks; ++j) {
    error = std::max({error, std::abs(reached.pitch[j] - planned.pitch[j]),
                      std::abs(reached.rate[j] - planned.rate[j]) / speed_max});
  }
  return error;
}

void examine_step(const PlanarModel& model, const PlanarMotion& motion, const PlanarKnot& knot,
                  Examiner& examiner) {
  const HeldStep step{model.dynamics, knot.phase, instant(model, motion, knot, 0.5 * knot.dt).tau};
  const int samples = std::max(1, static_cast<int>(std::ceil(knot.dt / kGrid)));
  const double h = knot.dt / samples;
  PlanarKnot now = knot;
  now.correction = {};
  now.promised.reset();
  LinkArray<double> before{};
  for (int i = 0; i <= samples; ++i) {
    now.time = knot.time + h * i;
    now.acceleration = step.acceleration(now.links);
    examiner.examine(instant(model, motion, now, 0.0), now.time);
    if (i == samples) break;
    const LinkArray<double> mean = i == 0 ? step.first_mean(now.links, now.acceleration, h)
                                          : HeldStep::next_mean(now.acceleration, before);
    now.links = HeldStep::advanced(now.links, mean, h);
    before = now.acceleration;
  }
  const LinkState planned = instant(model, motion, knot, knot.dt).links;
  examiner.note_violation(mismatch(now.links, planned, largest_speed(model.robot)));
}

}  // namespace

CertifiedMotion certify(const PlanarModel& model, const PlanarTask& task,
                        const PlanarMotion& motion) {
  Examiner examiner(model, task, motion);
  for (const PlanarKnot& knot : motion.knots) examine_step(model, motion, knot, examiner);
  return examiner.result();
}

}  // namespace hopscotch::planner
