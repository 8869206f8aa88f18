#pragma once

#include <filesystem>
#include <random>
#include <string>

#include "core/robot_state.hpp"
#include "model/kinematics.hpp"
#include "model/robot_parameters.hpp"

namespace hopscotch::model {

inline std::filesystem::path robot_file(const std::string& name) {
  return std::filesystem::path(HOPSCOTCH_SOURCE_DIR) / "config" / "robots" / (name + ".yaml");
}

inline RobotParameters load_robot(const std::string& name) {
  return RobotParameters::load(robot_file(name));
}

/// A posture inside the joint ranges of one leg.
inline core::LegVector random_leg(const RobotParameters& robot, core::Leg leg, std::mt19937& rng) {
  core::LegVector q;
  for (int i = 0; i < core::kJointsPerLeg; ++i) {
    const JointRange range = joint_range(robot, leg, static_cast<core::Joint>(i));
    q(i) = std::uniform_real_distribution<double>(range.lower, range.upper)(rng);
  }
  return q;
}

template <int N>
Eigen::Vector<double, N> random_vector(double magnitude, std::mt19937& rng) {
  std::uniform_real_distribution<double> uniform(-magnitude, magnitude);
  Eigen::Vector<double, N> v;
  for (int i = 0; i < N; ++i) v(i) = uniform(rng);
  return v;
}

/// Any posture, place and motion of the whole robot.
inline core::RobotState random_state(const RobotParameters& robot, std::mt19937& rng) {
  core::RobotState state;
  state.p_WB = random_vector<3>(1.0, rng);
  state.R_WB = rotation_from_rpy(random_vector<3>(1.5, rng));
  state.v_WB = random_vector<3>(2.0, rng);
  state.w_WB = random_vector<3>(3.0, rng);
  for (const core::Leg leg : core::kAllLegs) {
    state.q.segment<core::kJointsPerLeg>(core::leg_offset(leg)) = random_leg(robot, leg, rng);
  }
  state.dq = random_vector<core::kJoints>(8.0, rng);
  return state;
}

/// At rest with equal legs, trunk level, soles at z = 0 and x as far as the trunk puts them.
inline core::RobotState standing_state(const RobotParameters& robot, double hip, double knee) {
  core::RobotState state;
  core::LegVector q;
  q << 0.0, 0.0, hip, knee, -(hip + knee);
  state.q << q, q;
  state.dq.setZero();
  state.R_WB.setIdentity();
  state.v_WB.setZero();
  state.w_WB.setZero();
  state.p_WB.setZero();
  state.p_WB.z() = -leg_poses(robot, core::Leg::left, q).X_BF.translation().z();
  return state;
}

}  // namespace hopscotch::model
