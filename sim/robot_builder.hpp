#pragma once

#include <string>

#include "model/robot_parameters.hpp"

namespace hopscotch::sim {

/// Collision masks: the robot meets the terrain, neither meets itself.
inline constexpr int kRobotContype = 2;
inline constexpr int kRobotConaffinity = 1;
inline constexpr int kTerrainContype = 1;
inline constexpr int kTerrainConaffinity = 2;

/// Geom groups: what one sees, and what collides.
inline constexpr int kVisualGroup = 1;
inline constexpr int kCollisionGroup = 3;

/// The robot as MJCF, piece by piece, for a document that adds a terrain.
///
/// Names: body `trunk` with free joint `root`; bodies `left_hip`, `left_hip2`, `left_thigh`,
/// `left_shank`, `left_foot` and the same on the right; hinges and motors `left_hip_yaw` ...
/// `right_ankle` in the order of core::JointVector; sites `imu` (at B, axes of B), `camera`,
/// `left_sole`, `right_sole` (frame F); sensors `gyro` and `accelerometer` at `imu`. Collision
/// geoms of the feet: `left_toe`, `left_heel` (spheres that touch the ground exactly below toe and
/// heel), `left_bar` between them (5 mm above the sole: it meets edges, never flat ground); of the
/// rest: `left_shank`, `left_thigh`, `trunk`.
///
/// The actuators are ideal torque sources: limits of the motors are the plant's business. The
/// inertia of the ankle rotors couples knee and ankle, which no MJCF attribute can say: step the
/// model with `AnkleCoupling` of `sim/ankle_coupling.hpp`.
struct RobotXml {
  std::string assets;     ///< Children of <asset>.
  std::string body;       ///< Child of <worldbody>.
  std::string actuators;  ///< Children of <actuator>.
  std::string sensors;    ///< Children of <sensor>.
};

/// @param friction Of the robot's own geoms [-]. MuJoCo takes the larger one of two geoms in
///                 contact unless one has a higher `priority`.
[[nodiscard]] RobotXml robot_xml(const model::RobotParameters& robot, double friction);

/// Attributes of a geom that can be touched: condim, friction, solref, solimp; the same on robot
/// and terrain, since MuJoCo averages the two.
[[nodiscard]] std::string contact_attributes(double friction);

/// Top-level elements that every document with the robot needs: compiler, option (1 ms, Newton,
/// elliptic cones), size, statistic, visual (off-screen buffer 1280 x 720).
[[nodiscard]] std::string simulation_settings();

/// A complete document: the robot alone in empty space, straight legs, soles at z = 0.
[[nodiscard]] std::string standalone_robot_mjcf(const model::RobotParameters& robot);

}  // namespace hopscotch::sim
