#include "model/robot_parameters.hpp"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <numbers>
#include <string_view>

#include "core/config_reader.hpp"

namespace hopscotch::model {

namespace {

using core::ConfigReader;
using core::Range;

constexpr double kUnitLengthTolerance = 1e-9;
constexpr double kTurn = 2.0 * std::numbers::pi;

/// The axes that leg inverse kinematics and the sagittal chain rely on.
const std::array<Eigen::Vector3d, core::kJointsPerLeg> kJointAxes{
    Eigen::Vector3d::UnitZ(), Eigen::Vector3d::UnitX(), Eigen::Vector3d::UnitY(),
    Eigen::Vector3d::UnitY(), Eigen::Vector3d::UnitY()};

/// A tensor belongs to a real body if no principal moment exceeds the sum of the other two.
bool is_physical(const Eigen::Matrix3d& inertia) {
  const Eigen::Vector3d moments =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(inertia, Eigen::EigenvaluesOnly).eigenvalues();
  return moments(0) > 0.0 && moments(2) <= moments(0) + moments(1);
}

/// [xx, yy, zz, xy, xz, yz] as a tensor.
Eigen::Matrix3d read_inertia(const ConfigReader& section) {
  const Eigen::Vector<double, 6> i = section.vector<6>("inertia_kgm2");
  Eigen::Matrix3d inertia;
  inertia << i(0), i(3), i(4), i(3), i(1), i(5), i(4), i(5), i(2);
  if (!is_physical(inertia)) section.reject("inertia_kgm2", "must be the tensor of a real body");
  return inertia;
}

LinkParameters read_link(const ConfigReader& section) {
  LinkParameters link;
  link.mass = section.number("mass_kg", Range::positive());
  link.com = section.vector<3>("com_m");
  link.inertia = read_inertia(section);
  section.finish();
  return link;
}

JointParameters read_joint(const ConfigReader& section, core::Joint which) {
  JointParameters joint;
  joint.origin = section.vector<3>("origin_m");
  joint.axis = section.vector<3>("axis");
  if ((joint.axis - kJointAxes[core::index(which)]).norm() > kUnitLengthTolerance) {
    section.reject("axis", "must be z for hip yaw, x for hip roll and y for the pitch joints");
  }
  const bool below_parent = which == core::Joint::knee || which == core::Joint::ankle;
  if (below_parent && (joint.origin.x() != 0.0 || joint.origin.z() >= 0.0)) {
    section.reject("origin_m", "must lie straight below the joint above (x = 0, z < 0)");
  }
  const Eigen::Vector2d range = section.vector<2>("range_rad", Range::closed(-kTurn, kTurn));
  if (range(0) >= range(1)) section.reject("range_rad", "must be [lower, upper]");
  joint.lower = range(0);
  joint.upper = range(1);
  joint.damping = section.number("damping_Nms_per_rad", Range::not_negative());
  joint.friction = section.number("friction_Nm", Range::not_negative());
  joint.link = read_link(section.section("link"));
  section.finish();
  return joint;
}

MotorParameters read_motor(const ConfigReader& section) {
  MotorParameters motor;
  motor.torque_max = section.number("torque_max_Nm", Range::positive());
  motor.speed_max = section.number("speed_max_radps", Range::positive());
  motor.corner_speed = section.number("corner_speed_radps", Range::positive());
  if (motor.corner_speed >= motor.speed_max) {
    section.reject("corner_speed_radps", "must be below speed_max_radps");
  }
  motor.armature = section.number("armature_kgm2", Range::not_negative());
  section.finish();
  return motor;
}

void read_foot(const ConfigReader& section, RobotParameters& robot) {
  robot.sole = section.vector<3>("sole_m");
  if (robot.sole.x() != 0.0 || robot.sole.z() >= 0.0) {
    section.reject("sole_m", "must lie straight below the ankle (x = 0, z < 0)");
  }
  robot.toe = section.number("toe_m", Range::positive());
  robot.heel = section.number("heel_m", Range::positive());
  robot.foot_width = section.number("width_m", Range::positive());
  section.finish();
}

void read_collision(const ConfigReader& section, RobotParameters& robot) {
  robot.trunk_box = section.vector<3>("trunk_box_m", Range::positive());
  robot.shank_radius = section.number("shank_radius_m", Range::positive());
  robot.thigh_radius = section.number("thigh_radius_m", Range::positive());
  section.finish();
}

RobotParameters read_complete(const ConfigReader& file) {
  RobotParameters robot;
  robot.name = file.text("name");
  const ConfigReader trunk = file.section("trunk");
  robot.trunk.mass = trunk.number("mass_kg", Range::positive());
  robot.trunk.inertia = read_inertia(trunk);
  trunk.finish();

  const ConfigReader joints = file.section("joints");
  const ConfigReader motors = file.section("motors");
  for (std::size_t i = 0; i < core::kJointNames.size(); ++i) {
    const std::string_view name = core::kJointNames[i];
    robot.joints[i] = read_joint(joints.section(name), static_cast<core::Joint>(i));
    robot.motors[i] = read_motor(motors.section(name));
  }
  joints.finish();
  motors.finish();

  robot.motor_power_max = file.number("motor_power_max_W", Range::positive());
  robot.braking_power_max = file.number("braking_power_max_W", Range::positive());
  read_foot(file.section("foot"), robot);
  read_collision(file.section("collision"), robot);
  file.finish();
  return robot;
}

/// A robot that is another one with some motors exchanged. The other one stands in a file beside,
/// or under `base`.
RobotParameters read_variant(const ConfigReader& file, const std::filesystem::path& folder) {
  const std::string name = file.text("based_on") + ".yaml";
  const auto enclosed = file.section_if("base");
  const ConfigReader base = enclosed ? *enclosed : ConfigReader::from_file(folder / name);
  if (base.has("based_on")) file.reject("based_on", "must name a robot that is complete in itself");
  RobotParameters robot = read_complete(base);
  robot.name = file.text("name");
  const ConfigReader motors = file.section("motors");
  for (std::size_t i = 0; i < core::kJointNames.size(); ++i) {
    if (const auto motor = motors.section_if(core::kJointNames[i])) {
      robot.motors[i] = read_motor(*motor);
    }
  }
  motors.finish();
  file.finish();
  return robot;
}

double sagittal_length(const JointParameters& joint) {
  return std::hypot(joint.origin.x(), joint.origin.z());
}

}  // namespace

RobotParameters RobotParameters::load(const std::filesystem::path& file) {
  const ConfigReader reader = ConfigReader::from_file(file);
  return reader.has("based_on") ? read_variant(reader, file.parent_path()) : read_complete(reader);
}

double RobotParameters::total_mass() const {
  double leg = 0.0;
  for (const JointParameters& joint : joints) leg += joint.link.mass;
  return trunk.mass + core::kLegs * leg;
}

double RobotParameters::thigh_length() const {
  return sagittal_length(joints[core::index(core::Joint::knee)]);
}

double RobotParameters::shank_length() const {
  return sagittal_length(joints[core::index(core::Joint::ankle)]);
}

JointRange joint_range(const RobotParameters& robot, core::Leg leg, core::Joint joint) {
  const JointParameters& left = robot.joints[core::index(joint)];
  const bool swaps = joint == core::Joint::hip_yaw || joint == core::Joint::hip_roll;
  if (leg == core::Leg::right && swaps) return {-left.upper, -left.lower};
  return {left.lower, left.upper};
}

}  // namespace hopscotch::model
