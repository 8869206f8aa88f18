#pragma once

#include <Eigen/Core>
#include <vector>

#include "planner/planar_jump.hpp"

namespace hopscotch::planner {

/// What a jump to the side or with a turn adds to the planar motion at one instant, in S.
struct SideShift {
  Eigen::Vector2d shift = Eigen::Vector2d::Zero();         ///< Of the CoM, x and y [m].
  Eigen::Vector2d velocity = Eigen::Vector2d::Zero();      ///< [m/s]
  Eigen::Vector2d acceleration = Eigen::Vector2d::Zero();  ///< [m/s^2]
  double yaw = 0.0;                                        ///< Of the trunk [rad].
  double yaw_rate = 0.0;                                   ///< [rad/s]
  double yaw_acceleration = 0.0;                           ///< [rad/s^2]
  double sole_y = 0.0;                                     ///< Of the mid-point of the soles [m].
  double sole_y_rate = 0.0;                                ///< [m/s]
  double sole_yaw = 0.0;                                   ///< [rad]
  double sole_yaw_rate = 0.0;                              ///< [rad/s]
  double plane_yaw = 0.0;  ///< Heading of the planar motion: of S, after touchdown of the target.
};

/// Lifts the planar motion out of its plane: the last part of the takeoff gives the CoM a constant
/// speed to the side and the trunk a yaw rate; the flight keeps that speed (no force) and the
/// vertical angular momentum, so that the trunk falls behind while the legs turn to the target; the
/// first part of the landing takes both away. After touchdown the planar motion continues in the
/// plane of the target's soles. The soles leave the start at rest and come to rest on the target
/// before touchdown. Ramps are smooth in acceleration, so that the legs are loaded gradually.
class SideStep {
 public:
  /// @param lateral Of the target's mid-point, to the left of the jump line [m].
  /// @param yaw     Of the target's soles in S [rad].
  SideStep(const PlanarModel& model, const PlanarMotion& motion, double lateral, double yaw);

  /// @param time Since the start of the plan [s].
  /// @param phase To which the instant belongs; at touchdown both flight and landing do.
  [[nodiscard]] SideShift at(double time, core::JumpPhase phase) const;

  /// Of the flight: knots and mid-points in turn, `flight_instants()` of them.
  [[nodiscard]] std::size_t flight_instants() const { return flight_yaw_.size(); }
  /// The legs' swing to the side has vertical momentum too: the trunk's turn in flight is found
  /// anew from what the lifted robot has at each flight instant [kg·m^2/s].
  void account_for(const std::vector<double>& momentum);

  /// A point of the plane, x and z, in S; after touchdown turned about the target.
  [[nodiscard]] Eigen::Vector3d point(const model::PlanarVector<double>& p,
                                      core::JumpPhase phase) const;

 private:
  void measure_turn(const PlanarModel& model, const PlanarMotion& motion);
  void find_turn();
  void set_flight(double coasting, SideShift& now) const;

  double takeoff_from_ = 0.0;        ///< Begin of the ramp [s].
  double liftoff_ = 0.0;             ///< [s]
  double touchdown_ = 0.0;           ///< [s]
  double landing_ramp_ = 0.0;        ///< Its length [s].
  double lateral_ = 0.0;             ///< [m]
  double yaw_ = 0.0;                 ///< [rad]
  double liftoff_yaw_rate_ = 0.0;    ///< Of the trunk [rad/s].
  double touchdown_yaw_rate_ = 0.0;  ///< [rad/s]
  // At the flight instants.
  std::vector<double> trunk_inertia_;  ///< Momentum per yaw rate of the trunk over soles [kg·m^2].
  std::vector<double> other_momentum_;   ///< What does not come from the trunk's rate.
  std::vector<double> flight_yaw_;       ///< [rad]
  std::vector<double> flight_yaw_rate_;  ///< [rad/s]
  Eigen::Vector2d target_;               ///< Sole centre in S [m].
  Eigen::Vector2d velocity_;             ///< Added to the planar one in flight [m/s].
  Eigen::Vector2d remaining_;            ///< To be taken away in the landing [m/s].
};

}  // namespace hopscotch::planner
