#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>

#include "model/robot_parameters.hpp"
#include "sim/plant_truth.hpp"
#include "sim/terrain.hpp"

namespace hopscotch::sim {

/// Leans beyond this never recover; 0.8-0.9 rad is legitimate on the way to a 20 cm platform [rad].
inline constexpr double kTiltOfFall = 1.25;
/// Even with folded legs and a tilt of 1.25 rad the trunk's CoM is higher above the soles [m].
inline constexpr double kTrunkHeightOfFall = 0.15;
/// A toe or heel further over an edge than this counts as missed [m].
inline constexpr double kOverEdge = 0.005;

/// The robot has fallen: anything but a foot touches the terrain, a foot is in the pit, the trunk
/// lies or is too low. Says which, with numbers; nothing while it is up.
[[nodiscard]] std::optional<std::string> fall_of(const PlantTruth& truth);

/// Where a jump starts: frame S.
struct TakeoffPlace {
  Eigen::Vector3d p_WS;  ///< Mid-point of the soles [m].
  double heading;        ///< Of the trunk, yaw in W [rad].
};
[[nodiscard]] TakeoffPlace takeoff_place(const PlantTruth& truth);

/// A landing at rest, judged by the truth.
struct LandingVerdict {
  double distance;     ///< Between the mid-points of the soles along x of S [m].
  double lateral;      ///< To the left in S [m].
  double height;       ///< In S [m].
  double toe_margin;   ///< Support left ahead of the worse toe; negative: over the edge [m].
  double heel_margin;  ///< Support left behind the worse heel; negative: over the edge [m].
  bool over_edge;      ///< By more than `kOverEdge`: the jump counts as missed.
};
/// @param terrain The true one. A sole without any support has both margins at minus its length.
[[nodiscard]] LandingVerdict judge_landing(const Terrain& terrain,
                                           const model::RobotParameters& robot,
                                           const TakeoffPlace& from, const PlantTruth& rest);

/// How far the rear heel is from the origin of W along a heading [m]: the goal is reached when this
/// exceeds the scenario's `goal.x_m`.
[[nodiscard]] double heel_progress(const model::RobotParameters& robot, const PlantTruth& truth,
                                   double heading);

/// Largest use of the limits so far, as shares of each limit.
struct LoadPeaks {
  double torque_ratio = 0.0;
  double speed_ratio = 0.0;
  double power_ratio = 0.0;
  double braking_power = 0.0;  ///< [W]
  double normal_force = 0.0;   ///< Vertical, both feet [N].

  void include(const PlantTruth& truth);
};

}  // namespace hopscotch::sim
