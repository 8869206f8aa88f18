#include "sim/robot_builder.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <array>
#include <string_view>

#include "core/robot_layout.hpp"
#include "model/gravity.hpp"
#include "model/leg_mirror.hpp"
#include "sim/robot_look.hpp"
#include "sim/xml_element.hpp"

namespace hopscotch::sim {

namespace {

using core::Joint;
using core::Leg;
using Eigen::Vector3d;

constexpr double kTipRadius = 0.010;  // toe and heel spheres: half the sole's width [m]
constexpr double kBarRadius = 0.007;  // between them [m]
constexpr double kBarRise = 0.005;    // of the bar above the sole: more than any tip sinks in [m]

constexpr std::array<std::string_view, core::kJointsPerLeg> kLinkNames{"hip", "hip2", "thigh",
                                                                       "shank", "foot"};

std::string side_name(Leg leg, std::string_view part) {
  return std::string(core::kLegNames[core::index(leg)]) + "_" + std::string(part);
}

/// Mass properties in principal axes: MuJoCo's own diagonalisation of a full tensor keeps only nine
/// digits.
std::string inertial(const model::LinkParameters& link) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> principal(link.inertia);
  Eigen::Matrix3d axes = principal.eigenvectors();
  if (axes.determinant() < 0.0) axes.col(0) = -axes.col(0);
  const Eigen::Quaterniond turn(axes);
  return XmlElement("inertial")
      .with("pos", link.com)
      .with("quat", Eigen::Vector4d(turn.w(), turn.x(), turn.y(), turn.z()))
      .with("mass", link.mass)
      .with("diaginertia", principal.eigenvalues())
      .text();
}

XmlElement collision_geom(const std::string& name, const char* type, double friction) {
  XmlElement geom("geom");
  geom.with("name", name)
      .with("type", type)
      .with("material", "robot_contact")
      .with("group", kCollisionGroup)
      .with("contype", kRobotContype)
      .with("conaffinity", kRobotConaffinity)
      .with_attributes(contact_attributes(friction));
  return geom;
}

std::string capsule(const std::string& name, double radius, const Vector3d& from,
                    const Vector3d& to, double friction) {
  Eigen::Vector<double, 6> ends;
  ends << from, to;
  return collision_geom(name, "capsule", friction).with("size", radius).with("fromto", ends).text();
}

/// Spheres under toe and heel, tangent to the sole, and the bar between them.
std::string foot_collision(const model::RobotParameters& robot, Leg leg, double friction) {
  const Vector3d p_sole = model::sole_centre_in_foot(robot, leg);
  const Vector3d p_centre = p_sole + kTipRadius * Vector3d::UnitZ();
  const Vector3d to_toe = 0.5 * (robot.toe + robot.heel) * Vector3d::UnitX();
  const Vector3d p_bar = p_sole + (kBarRise + kBarRadius) * Vector3d::UnitZ();
  return collision_geom(side_name(leg, "toe"), "sphere", friction)
             .with("size", kTipRadius)
             .with("pos", p_centre + to_toe)
             .text() +
         collision_geom(side_name(leg, "heel"), "sphere", friction)
             .with("size", kTipRadius)
             .with("pos", p_centre - to_toe)
             .text() +
         capsule(side_name(leg, "bar"), kBarRadius, p_bar - to_toe, p_bar + to_toe, friction) +
         XmlElement("site")
             .with("name", side_name(leg, "sole"))
             .with("pos", p_sole)
             .with("size", 0.002)
             .text();
}

std::string link_collision(const model::RobotParameters& robot, Leg leg, Joint joint,
                           double friction) {
  if (joint == Joint::hip_pitch) {
    const Vector3d p_knee = model::joint_origin(robot, leg, Joint::knee);
    // The thigh's round ends lie inside the leg, so that the knee is as thin as the shank.
    const Vector3d end = robot.thigh_radius * p_knee.normalized();
    return capsule(side_name(leg, "thigh"), robot.thigh_radius, end, p_knee - end, friction);
  }
  if (joint == Joint::knee) {
    return capsule(side_name(leg, "shank"), robot.shank_radius, Vector3d::Zero(),
                   model::joint_origin(robot, leg, Joint::ankle), friction);
  }
  return joint == Joint::ankle ? foot_collision(robot, leg, friction) : std::string();
}

/// Diagonal of the reflected inertia in joint coordinates; `AnkleCoupling` adds the rest.
double joint_armature(const model::RobotParameters& robot, Joint joint) {
  const double own = robot.motors[core::index(joint)].armature;
  return joint == Joint::knee ? own + robot.motors[core::index(Joint::ankle)].armature : own;
}

std::string hinge(const model::RobotParameters& robot, Leg leg, Joint joint) {
  const model::JointParameters& parameters = robot.joints[core::index(joint)];
  const model::JointRange range = model::joint_range(robot, leg, joint);
  return XmlElement("joint")
      .with("name", side_name(leg, core::kJointNames[core::index(joint)]))
      .with("type", "hinge")
      .with("axis", parameters.axis)
      .with("limited", "true")
      .with("range", Eigen::Vector2d(range.lower, range.upper))
      .with("armature", joint_armature(robot, joint))
      .with("damping", parameters.damping)
      .with("frictionloss", parameters.friction)
      .text();
}

/// The link that a joint moves, with all links below it.
std::string link_body(const model::RobotParameters& robot, Leg leg, std::size_t i,
                      double friction) {
  if (i == core::kJointNames.size()) return {};
  const Joint joint = static_cast<Joint>(i);
  return XmlElement("body")
      .with("name", side_name(leg, kLinkNames[i]))
      .with("pos", model::joint_origin(robot, leg, joint))
      .containing(inertial(model::leg_link(robot, leg, joint)))
      .containing(hinge(robot, leg, joint))
      .containing(link_look(robot, leg, joint))
      .containing(link_collision(robot, leg, joint, friction))
      .containing(link_body(robot, leg, i + 1, friction))
      .text();
}

/// Optical frame C at the place where the camera is mounted unless a scenario moves it.
std::string camera_site() {
  const Vector3d p_BC(0.09, 0.0, 0.08);  // [m]
  constexpr double kPitch = 0.60;        // [rad], down
  Eigen::Matrix3d optical;               // columns: right, down, forward
  optical << 0.0, 0.0, 1.0, -1.0, 0.0, 0.0, 0.0, -1.0, 0.0;
  const Eigen::Quaterniond R_BC(Eigen::AngleAxisd(kPitch, Vector3d::UnitY()) * optical);
  return XmlElement("site")
      .with("name", "camera")
      .with("pos", p_BC)
      .with("quat", Eigen::Vector4d(R_BC.w(), R_BC.x(), R_BC.y(), R_BC.z()))
      .with("size", 0.002)
      .text();
}

/// Trunk origin above the soles with straight legs [m].
double straight_height(const model::RobotParameters& robot) {
  double depth = robot.sole.z();
  for (const model::JointParameters& joint : robot.joints) depth += joint.origin.z();
  return -depth;
}

std::string trunk_body(const model::RobotParameters& robot, double friction) {
  XmlElement trunk("body");
  trunk.with("name", "trunk")
      .with("pos", Vector3d(0.0, 0.0, straight_height(robot)))
      .containing(inertial(robot.trunk))
      .containing(XmlElement("freejoint").with("name", "root").text())
      .containing(XmlElement("site").with("name", "imu").with("size", 0.002).text())
      .containing(camera_site())
      .containing(trunk_look(robot))
      .containing(
          collision_geom("trunk", "box", friction).with("size", 0.5 * robot.trunk_box).text());
  for (const Leg leg : core::kAllLegs) trunk.containing(link_body(robot, leg, 0, friction));
  return trunk.text();
}

std::string joint_motors() {
  std::string motors;
  for (const Leg leg : core::kAllLegs) {
    for (const std::string_view joint : core::kJointNames) {
      const std::string name = side_name(leg, joint);
      motors += XmlElement("motor").with("name", name).with("joint", name).with("gear", 1).text();
    }
  }
  return motors;
}

std::string imu_sensors() {
  return XmlElement("gyro").with("name", "gyro").with("site", "imu").text() +
         XmlElement("accelerometer").with("name", "accelerometer").with("site", "imu").text();
}

}  // namespace

RobotXml robot_xml(const model::RobotParameters& robot, double friction) {
  return {look_materials(), trunk_body(robot, friction), joint_motors(), imu_sensors()};
}

std::string contact_attributes(double friction) {
  // Torsional and rolling friction are without effect at condim 3: MuJoCo's defaults.
  const XmlElement element = XmlElement("")
                                 .with("friction", Vector3d(friction, 0.005, 0.0001))
                                 .with("condim", 3)
                                 .with("solref", "0.008 1")
                                 .with("solimp", "0.9 0.95 0.001");
  return element.attributes();
}

std::string simulation_settings() {
  const std::string compiler = XmlElement("compiler")
                                   .with("angle", "radian")
                                   .with("autolimits", "true")
                                   .with("inertiafromgeom", "false")
                                   .with("balanceinertia", "false")
                                   .text();
  const std::string option = XmlElement("option")
                                 .with("timestep", 0.001)
                                 .with("gravity", Vector3d(0.0, 0.0, -model::kGravity))
                                 .with("integrator", "Euler")
                                 .with("solver", "Newton")
                                 .with("iterations", 50)
                                 .with("cone", "elliptic")
                                 .with("impratio", 10)
                                 .text();
  const std::string size = XmlElement("size").with("njmax", 400).with("nconmax", 100).text();
  // The renderer's near plane is a share of the extent, which a long course would push into view.
  const std::string statistic = XmlElement("statistic").with("extent", 1).text();
  const std::string off_screen =
      XmlElement("global").with("offwidth", 1280).with("offheight", 720).text();
  const std::string shadows = XmlElement("map").with("shadowclip", 2.5).text();  // [m] around it
  const std::string visual = XmlElement("visual").containing(off_screen + shadows).text();
  return compiler + option + size + statistic + visual;
}

std::string standalone_robot_mjcf(const model::RobotParameters& robot) {
  constexpr double kFriction = 0.6;  // nothing to rub on
  const RobotXml xml = robot_xml(robot, kFriction);
  return XmlElement("mujoco")
      .with("model", robot.name)
      .containing(simulation_settings())
      .containing(XmlElement("asset").containing(xml.assets).text())
      .containing(XmlElement("worldbody").containing(xml.body).text())
      .containing(XmlElement("actuator").containing(xml.actuators).text())
      .containing(XmlElement("sensor").containing(xml.sensors).text())
      .text();
}

}  // namespace hopscotch::sim
