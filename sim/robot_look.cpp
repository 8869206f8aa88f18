#include "sim/robot_look.hpp"

#include <Eigen/Geometry>

#include "model/leg_mirror.hpp"
#include "sim/robot_builder.hpp"
#include "sim/xml_element.hpp"

namespace hopscotch::sim {

namespace {

using core::Joint;
using core::Leg;
using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::Vector4d;

constexpr double kMotorRadius = 0.045;        // A1 motor [m]
constexpr double kMotorHalfLength = 0.020;    // [m]
constexpr double kMotorCapRadius = 0.030;     // bright lid, for looks [m]
constexpr double kKneeMotorDrop = 0.095;      // knee motor below the hip-pitch axis [m]
constexpr double kThighMotorOffset = 0.058;   // motors of the thigh outboard of its frame [m]
constexpr double kRollMotorAhead = 0.0325;    // roll motor ahead of the roll joint's origin [m]
constexpr double kPitchMotorInboard = 0.015;  // pitch motor inboard of the roll axis [m]

std::string material(const char* name, const Vector4d& rgba, const Vector2d& gloss) {
  return XmlElement("material")
      .with("name", name)
      .with("rgba", rgba)
      .with("specular", gloss(0))
      .with("shininess", gloss(1))
      .text();
}

XmlElement visual(const char* type, const char* material_name) {
  XmlElement geom("geom");
  geom.with("type", type)
      .with("material", material_name)
      .with("contype", 0)
      .with("conaffinity", 0)
      .with("group", kVisualGroup);
  return geom;
}

std::string box(const char* material_name, const Vector3d& centre, const Vector3d& half_extents) {
  return visual("box", material_name).with("pos", centre).with("size", half_extents).text();
}

std::string ellipsoid(const char* material_name, const Vector3d& centre, const Vector3d& radii) {
  return visual("ellipsoid", material_name).with("pos", centre).with("size", radii).text();
}

/// A cylinder or capsule between two points.
std::string rod(const char* type, const char* material_name, const Vector3d& from,
                const Vector3d& to, double radius) {
  Eigen::Vector<double, 6> ends;
  ends << from, to;
  return visual(type, material_name).with("fromto", ends).with("size", radius).text();
}

/// A motor with a bright lid on the side that `axis` points to.
std::string motor(const Vector3d& centre, const Vector3d& axis) {
  const Vector3d half = kMotorHalfLength * axis;
  constexpr double kLidThickness = 0.004;
  return rod("cylinder", "robot_motor", centre - half, centre + half, kMotorRadius) +
         rod("cylinder", "robot_accent", centre + half, centre + half + kLidThickness * axis,
             kMotorCapRadius);
}

/// The sun: it moves along with the robot, since MuJoCo draws shadows only around where a light
/// points.
std::string key_light() {
  const Vector3d direction(-0.35, 0.55, -1.0);
  constexpr double kRange = 4.0;  // [m]
  return XmlElement("light")
      .with("name", "sun")
      .with("mode", "trackcom")
      .with("directional", "true")
      .with("castshadow", "true")
      .with("pos", -kRange * direction)
      .with("dir", direction)
      .with("diffuse", Vector3d(0.72, 0.72, 0.70))
      .with("ambient", Vector3d(0.22, 0.22, 0.25))
      .with("specular", Vector3d(0.2, 0.2, 0.2))
      .text();
}

double side_of(Leg leg) {
  return leg == Leg::left ? 1.0 : -1.0;
}

std::string hip_look(const model::RobotParameters& robot, Leg leg) {
  const Vector3d p_roll = model::joint_origin(robot, leg, Joint::hip_roll);
  const Vector3d p_motor = p_roll + kRollMotorAhead * Vector3d::UnitX();
  return rod("capsule", "robot_steel", Vector3d::Zero(),
             Vector3d(0.4 * p_roll.x(), 0.4 * p_roll.y(), 0.7 * p_roll.z()), 0.022) +
         rod("capsule", "robot_steel",
             Vector3d(0.4 * p_roll.x(), 0.4 * p_roll.y(), 0.7 * p_roll.z()), p_roll, 0.020) +
         motor(p_motor, Vector3d::UnitX());
}

std::string hip2_look(const model::RobotParameters& robot, Leg leg) {
  const Vector3d p_pitch = model::joint_origin(robot, leg, Joint::hip_pitch);
  const double side = side_of(leg);
  const Vector3d p_motor(p_pitch.x(), -kPitchMotorInboard * side, p_pitch.z());
  return rod("capsule", "robot_steel", Vector3d::Zero(), 0.5 * p_pitch, 0.024) +
         motor(p_motor, -side * Vector3d::UnitY());
}

std::string thigh_look(const model::RobotParameters& robot, Leg leg) {
  const Vector3d p_knee = model::joint_origin(robot, leg, Joint::knee);
  const double side = side_of(leg);
  const Vector3d outboard = side * Vector3d::UnitY();
  const Vector3d p_ankle_motor = kThighMotorOffset * outboard;
  const Vector3d p_knee_motor = p_ankle_motor - kKneeMotorDrop * Vector3d::UnitZ();
  const Vector3d shell_top(0.0, p_knee.y(), 0.0);
  return motor(p_ankle_motor, outboard) + motor(p_knee_motor, outboard) +
         rod("capsule", "robot_shell", shell_top, p_knee, 0.024) +
         ellipsoid("robot_shell", shell_top + Vector3d(0.0, 0.0, -0.05),
                   Vector3d(0.042, 0.026, 0.075));
}

std::string shank_look(const model::RobotParameters& robot, Leg leg) {
  const Vector3d p_ankle = model::joint_origin(robot, leg, Joint::ankle);
  const Vector3d half_width = 0.026 * Vector3d::UnitY();
  return rod("cylinder", "robot_motor", -half_width, half_width, 0.028) +
         rod("capsule", "robot_steel", Vector3d::Zero(), p_ankle, 0.013) +
         ellipsoid("robot_shell", 0.42 * p_ankle, Vector3d(0.021, 0.018, 0.078));
}

std::string foot_look(const model::RobotParameters& robot, Leg leg) {
  constexpr double kRubber = 0.006;  // half thickness of the sole [m]
  const Vector3d p_sole = model::sole_centre_in_foot(robot, leg);
  const Vector3d half_width = 0.016 * Vector3d::UnitY();
  const Vector3d p_instep = p_sole + Vector3d(0.0, 0.0, 2.0 * kRubber);
  const double half_length = 0.5 * (robot.toe + robot.heel);
  return rod("cylinder", "robot_motor", -half_width, half_width, 0.017) +
         rod("capsule", "robot_shell", Vector3d::Zero(), p_instep + Vector3d(0.03, 0.0, 0.0),
             0.009) +
         rod("capsule", "robot_shell", Vector3d::Zero(), p_instep - Vector3d(0.04, 0.0, 0.0),
             0.009) +
         box("robot_rubber", p_sole + Vector3d(0.0, 0.0, kRubber),
             Vector3d(half_length, 0.5 * robot.foot_width, kRubber));
}

}  // namespace

std::string look_materials() {
  return material("robot_shell", {0.93, 0.92, 0.89, 1.0}, {0.4, 0.5}) +
         material("robot_motor", {0.13, 0.14, 0.16, 1.0}, {0.6, 0.6}) +
         material("robot_steel", {0.45, 0.47, 0.50, 1.0}, {0.7, 0.6}) +
         material("robot_accent", {0.88, 0.33, 0.12, 1.0}, {0.4, 0.5}) +
         material("robot_rubber", {0.07, 0.07, 0.08, 1.0}, {0.1, 0.1}) +
         material("robot_lens", {0.05, 0.12, 0.22, 1.0}, {0.9, 0.9}) +
         material("robot_contact", {0.20, 0.55, 0.95, 0.4}, {0.0, 0.0});
}

std::string trunk_look(const model::RobotParameters& robot) {
  const Vector3d half = 0.5 * robot.trunk_box;
  const Vector3d p_yaw = model::joint_origin(robot, Leg::left, Joint::hip_yaw);
  const Vector3d p_yaw_motor = p_yaw + kMotorHalfLength * Vector3d::UnitZ();
  const Vector3d p_camera(half.x(), 0.0, 0.08);
  const Vector3d mirror(1.0, -1.0, 1.0);
  return key_light() +
         box("robot_shell", Vector3d::Zero(),
             Vector3d(0.92 * half.x(), 0.90 * half.y(), 0.92 * half.z())) +
         box("robot_motor", Vector3d(-0.35 * half.x(), 0.0, 0.0),
             Vector3d(0.66 * half.x(), half.y(), 0.70 * half.z())) +
         box("robot_accent", Vector3d(0.94 * half.x(), 0.0, -0.25 * half.z()),
             Vector3d(0.03 * half.x(), 0.60 * half.y(), 0.10 * half.z())) +
         ellipsoid("robot_shell", Vector3d(0.0, 0.0, 0.92 * half.z()),
                   Vector3d(0.88 * half.x(), 0.86 * half.y(), 0.24 * half.z())) +
         motor(p_yaw_motor, -Vector3d::UnitZ()) +
         motor(p_yaw_motor.cwiseProduct(mirror), -Vector3d::UnitZ()) +
         box("robot_motor", p_camera, Vector3d(0.018, 0.050, 0.014)) +
         rod("cylinder", "robot_lens", p_camera + Vector3d(0.018, 0.028, 0.0),
             p_camera + Vector3d(0.021, 0.028, 0.0), 0.009) +
         rod("cylinder", "robot_lens", p_camera + Vector3d(0.018, -0.028, 0.0),
             p_camera + Vector3d(0.021, -0.028, 0.0), 0.009);
}

std::string link_look(const model::RobotParameters& robot, Leg leg, Joint joint) {
  switch (joint) {
    case Joint::hip_yaw: return hip_look(robot, leg);
    case Joint::hip_roll: return hip2_look(robot, leg);
    case Joint::hip_pitch: return thigh_look(robot, leg);
    case Joint::knee: return shank_look(robot, leg);
    case Joint::ankle: return foot_look(robot, leg);
  }
  return {};
}

}  // namespace hopscotch::sim
