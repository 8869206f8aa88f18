#pragma once

#include <mujoco/mujoco.h>

#include <Eigen/Dense>
#include <string>

#include "core/robot_state.hpp"
#include "model/robot_parameters.hpp"
#include "sim/ankle_coupling.hpp"
#include "sim/mujoco_model.hpp"
#include "sim/robot_builder.hpp"
#include "tests/unit/model/robots.hpp"

namespace hopscotch::sim {

/// The robot alone in space, as MuJoCo sees it: the referee of the model's mathematics. Contacts,
/// joint ranges and dry friction are switched off.
struct MujocoRobot {
  static constexpr int kVelocities = 6 + core::kJoints;
  using Velocity = Eigen::Vector<double, kVelocities>;
  using MassMatrix = Eigen::Matrix<double, kVelocities, kVelocities>;

  model::RobotParameters robot;
  ModelPointer mj;
  DataPointer data;
  AnkleCoupling coupling;

  explicit MujocoRobot(const std::string& name)
      : robot(model::load_robot(name)),
        mj(compile_model(standalone_robot_mjcf(robot))),
        data(make_data(*mj)),
        coupling(*mj, robot) {
    mj->opt.disableflags |= mjDSBL_CONSTRAINT;
  }

  /// Free joint: place in W, quaternion (w x y z); velocity in W, angular velocity in B.
  void place(const core::RobotState& state) {
    const Eigen::Quaterniond turn(state.R_WB);
    Eigen::Map<Eigen::Vector<double, 7 + core::kJoints>>(data->qpos) << state.p_WB, turn.w(),
        turn.vec(), state.q;
    Eigen::Map<Velocity>(data->qvel) << state.v_WB, state.R_WB.transpose() * state.w_WB, state.dq;
    coupling.forward(*mj, *data);
  }

  [[nodiscard]] MassMatrix mass_matrix() const {
    Eigen::Matrix<double, kVelocities, kVelocities, Eigen::RowMajor> dense;
    mj_fullM(mj.get(), dense.data(), data->qM);
    return dense;
  }
  [[nodiscard]] Velocity bias() const { return Eigen::Map<const Velocity>(data->qfrc_bias); }
  [[nodiscard]] Velocity passive() const { return Eigen::Map<const Velocity>(data->qfrc_passive); }
  [[nodiscard]] Velocity acceleration() const { return Eigen::Map<const Velocity>(data->qacc); }

  [[nodiscard]] Eigen::Isometry3d site_pose(const std::string& name) const {
    return pose(data->site_xpos, data->site_xmat, element_id(*mj, mjOBJ_SITE, name));
  }
  [[nodiscard]] Eigen::Isometry3d body_pose(const std::string& name) const {
    return pose(data->xpos, data->xmat, element_id(*mj, mjOBJ_BODY, name));
  }

 private:
  static Eigen::Isometry3d pose(const mjtNum* positions, const mjtNum* matrices, int id) {
    Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
    X.translation() = Eigen::Map<const Eigen::Vector3d>(positions + 3 * id);
    X.linear() = Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(matrices + 9 * id);
    return X;
  }
};

}  // namespace hopscotch::sim
