#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "core/jump_plan.hpp"
#include "model/planar_dynamics.hpp"
#include "model/robot_parameters.hpp"
#include "planner/planner_config.hpp"
#include "planner/smooth_terrain.hpp"

namespace hopscotch::planner {

/// Pitches and rates of the links at one instant.
struct LinkState {
  model::LinkArray<double> pitch{};  ///< [rad]
  model::LinkArray<double> rate{};   ///< [rad/s]
};

/// One jump in the sagittal plane, frame S with the start's sole centre at its origin.
struct PlanarTask {
  LinkState start;  ///< Feet flat at the origin of S; of a jump that is down, at the target.
  model::LinkArray<double> final_posture{};  ///< At rest, feet flat at the target [rad].
  double distance = 0.0;                     ///< Sole centre to sole centre [m].
  double height = 0.0;                       ///< Of the target sole [m].
  double clearance = 0.0;                    ///< Of toe and heel in mid-flight [m].
  SmoothTerrain terrain;
};

/// What every phase is built from.
struct PlanarModel {
  model::RobotParameters robot;
  model::PlanarDynamics dynamics;
  PlannerConfig config;

  PlanarModel(const model::RobotParameters& parameters, const PlannerConfig& tuning)
      : robot(parameters), dynamics(model::lump_legs(parameters)), config(tuning) {}

  /// Ankle axis ahead of the sole centre [m].
  [[nodiscard]] double ankle_x() const { return -robot.sole_centre(); }
};

/// What the planner adds to a step so that its torques, held over the step, really make it (see
/// ChainCorrection). Links of absolute pitch.
struct StepCorrection {
  model::LinkArray<double> turn{};          ///< Pitch at the end beyond the trapezoid [rad].
  model::LinkArray<double> acceleration{};  ///< That torques are computed for, more [rad/s^2].
};

/// What a simpler model takes for true during a step, in place of what the chain of links does.
struct PromisedStep {
  model::PlanarJoints<double> tau{};             ///< Joint torques [N·m].
  model::PlanarVector<double> force{};           ///< Ground on the feet [N].
  double moment = 0.0;                           ///< Of that force about the ankle axis [N·m].
  model::PlanarVector<double> ankle{};           ///< At the knot [m].
  model::PlanarVector<double> ankle_velocity{};  ///< [m/s]
};

/// A knot of the planar motion and the step that follows it, in which the angular accelerations of
/// the links are constant but for the correction.
struct PlanarKnot {
  core::JumpPhase phase = core::JumpPhase::takeoff;
  double time = 0.0;  ///< Since the start [s].
  double dt = 0.0;    ///< Length of the step; 0 at the last knot [s].
  LinkState links;    ///< At the knot; at touchdown after the ground has stopped the foot.
  model::LinkArray<double> acceleration{};  ///< During the step [rad/s^2].
  StepCorrection correction;
  std::optional<PromisedStep> promised;
};

/// Everything about the motion at one instant. Two legs together, frame S.
struct PlanarInstant {
  core::JumpPhase phase = core::JumpPhase::takeoff;
  LinkState links;
  model::PlanarVector<double> ankle{};           ///< Ankle axis [m].
  model::PlanarVector<double> ankle_velocity{};  ///< [m/s]
  model::PlanarJoints<double> tau{};             ///< Joint torques [N·m].
  model::PlanarVector<double> force{};           ///< Ground on the feet [N].
  double moment = 0.0;                           ///< Of that force about the ankle axis [N·m].
};

/// The solved motion: takeoff, flight and landing knots in order, of a jump that is down the latter
/// alone; the last one is at rest.
struct PlanarMotion {
  std::vector<PlanarKnot> knots;
  model::PlanarVector<double> start_ankle{};       ///< During takeoff, in S [m].
  model::PlanarVector<double> target_ankle{};      ///< During landing, in S [m].
  model::PlanarVector<double> liftoff_com{};       ///< In S [m].
  model::PlanarVector<double> liftoff_velocity{};  ///< [m/s]
  double momentum = 0.0;                           ///< Centroidal, about +y [kg·m^2/s].
  double liftoff_time = 0.0;                       ///< [s]
  double touchdown_time = 0.0;                     ///< [s]
};

/// Reads the motion off a decision vector.
[[nodiscard]] PlanarMotion motion_from_decision(const PlanarModel& model, const PlanarTask& task,
                                                const DecisionLayout& layout,
                                                const Eigen::VectorXd& x);

/// The motion `elapsed` after a knot, 0 <= elapsed <= dt [s].
[[nodiscard]] PlanarInstant instant(const PlanarModel& model, const PlanarMotion& motion,
                                    const PlanarKnot& knot, double elapsed);

}  // namespace hopscotch::planner
