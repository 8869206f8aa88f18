#pragma once

#include <Eigen/Geometry>

#include "control/wrench_mpc.hpp"
#include "core/config_reader.hpp"
#include "model/kinematics.hpp"
#include "model/rigid_body.hpp"
#include "model/robot_parameters.hpp"

namespace hopscotch::control::testing {

inline core::ConfigReader mpc_section() {
  return core::ConfigReader::from_file(std::filesystem::path(HOPSCOTCH_SOURCE_DIR) / "config" /
                                       "hopscotch.yaml")
      .section("control")
      .section("wrench_mpc");
}

inline model::RobotParameters hector() {
  return model::RobotParameters::load(std::filesystem::path(HOPSCOTCH_SOURCE_DIR) / "config" /
                                      "robots" / "hector.yaml");
}

/// At rest on flat soles, knees at -90 degrees, heading along `yaw` [rad].
inline core::RobotState standing(const model::RobotParameters& robot, double yaw = 0.0) {
  constexpr double kHip = 0.7853981633974483;
  core::LegVector q;
  q << 0.0, 0.0, kHip, -2.0 * kHip, kHip;
  core::RobotState state;
  state.q << q, q;
  state.dq.setZero();
  state.R_WB = Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  state.v_WB.setZero();
  state.w_WB.setZero();
  state.p_WB = {0.0, 0.0, -model::leg_poses(robot, core::Leg::left, q).X_BF.translation().z()};
  state.contact = {true, true};
  return state;
}

/// Stay as `state` is for `horizon` steps of `dt` on both feet, each bearing half of the weight.
inline core::ControlReference stay(const model::RobotParameters& robot,
                                   const core::RobotState& state, std::size_t horizon,
                                   double dt = 0.03) {
  const model::CompositeBody body = model::composite_body(robot, state);
  const auto X_WF = model::sole_poses(robot, state);
  core::ControlReference reference;
  reference.stamp = state.stamp;
  reference.horizon = horizon;
  for (std::size_t k = 0; k <= horizon; ++k) {
    core::ReferenceKnot& knot = reference.knots[k];
    knot.dt = dt;
    knot.contact = {true, true};
    knot.p_WG = body.p_WG;
    knot.rpy = model::rpy_from_rotation(state.R_WB);
    knot.v_WG.setZero();
    knot.w_WB.setZero();
    for (std::size_t leg = 0; leg < core::kLegs; ++leg) {
      knot.p_WF[leg] = X_WF[leg].translation();
      knot.wrenches[leg].force = {0.0, 0.0, 0.5 * body.mass * 9.80665};
    }
  }
  return reference;
}

}  // namespace hopscotch::control::testing
