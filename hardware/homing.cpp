#include "hardware/homing.hpp"

#include <array>
#include <cmath>
#include <cstdio>

#include "hardware/bus_topology.hpp"

namespace hopscotch::hardware {
namespace {

std::string with_three_digits(double value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.3f", value);
  return text.data();
}

/// Joints whose positive sense turns around in the mirror.
bool mirrored(int joint) {
  return joint == static_cast<int>(core::Joint::hip_yaw) ||
         joint == static_cast<int>(core::Joint::hip_roll);
}

}  // namespace

HomingConfig HomingConfig::load(const core::ConfigReader& section) {
  HomingConfig config;
  config.pose = section.vector<core::kJointsPerLeg>("pose_rad", core::Range::closed(-3.2, 3.2));
  config.tolerance = section.number("tolerance_rad", core::Range::above(0.0, 0.5));
  section.finish();
  return config;
}

core::JointVector HomingConfig::joints() const {
  core::JointVector joints;
  joints << pose, pose;
  for (int joint = 0; joint < core::kJointsPerLeg; ++joint) {
    if (mirrored(joint)) joints(core::kJointsPerLeg + joint) = -pose(joint);
  }
  return joints;
}

std::string homing_problem(const HomingConfig& config, const model::RobotParameters& robot,
                           const core::JointVector& q) {
  const core::JointVector home = config.joints();
  std::string problem;
  for (int i = 0; i < core::kJoints; ++i) {
    const auto leg = static_cast<core::Leg>(i / core::kJointsPerLeg);
    const auto joint = static_cast<core::Joint>(i % core::kJointsPerLeg);
    const model::JointRange range = model::joint_range(robot, leg, joint);
    std::string what;
    if (std::isnan(q(i))) {
      what = "has not answered";
    } else if (q(i) < range.lower || q(i) > range.upper) {
      what = "reads " + with_three_digits(q(i)) + " rad, outside of its range " +
             with_three_digits(range.lower) + " to " + with_three_digits(range.upper);
    } else if (std::abs(q(i) - home(i)) > config.tolerance) {
      what = "reads " + with_three_digits(q(i)) + " rad, but home is " +
             with_three_digits(home(i)) + " +- " + with_three_digits(config.tolerance);
    }
    if (what.empty()) continue;
    problem += (problem.empty() ? "" : "; ") + joint_name(i) + " " + what;
  }
  return problem;
}

}  // namespace hopscotch::hardware
