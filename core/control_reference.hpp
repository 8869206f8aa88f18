#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>

#include "core/contact_wrenches.hpp"
#include "core/robot_state.hpp"

namespace hopscotch::core {

/// What the MPC is to track at one knot of its window.
struct ReferenceKnot {
  double dt = kNaN;                                        ///< Step from this knot to the next [s].
  std::array<bool, kLegs> contact{};                       ///< During that step.
  Eigen::Vector3d p_WG = Eigen::Vector3d::Constant(kNaN);  ///< Whole-body CoM [m].
  Eigen::Vector3d rpy = Eigen::Vector3d::Constant(kNaN);   ///< Of the trunk in W [rad].
  Eigen::Vector3d v_WG = Eigen::Vector3d::Constant(kNaN);  ///< [m/s]
  Eigen::Vector3d w_WB = Eigen::Vector3d::Constant(kNaN);  ///< In W [rad/s].
  std::array<Eigen::Vector3d, kLegs> p_WF{};               ///< Sole centres during the step [m].
  ContactWrenches wrenches{};                              ///< Planned wrench of the step.
};

/// The next h steps of the plan with their own step lengths: h + 1 knots, of which the last gives
/// the state at the end of the window.
struct ControlReference {
  static constexpr std::size_t kMaxHorizon = 20;
  Stamp stamp;              ///< Moment of knot 0.
  std::size_t horizon = 0;  ///< h
  std::array<ReferenceKnot, kMaxHorizon + 1> knots{};
};

}  // namespace hopscotch::core
