#include "model/stand_posture.hpp"

#include <cmath>

namespace hopscotch::model {

namespace {

/// Both legs with zero yaw and roll.
core::JointVector joint_vector(const PlanarJoints<double>& joints) {
  core::JointVector q = core::JointVector::Zero();
  for (const core::Leg leg : core::kAllLegs) {
    q(core::joint_index(leg, core::Joint::hip_pitch)) = joints.hip;
    q(core::joint_index(leg, core::Joint::knee)) = joints.knee;
    q(core::joint_index(leg, core::Joint::ankle)) = joints.ankle;
  }
  return q;
}

bool within_ranges(const RobotParameters& robot, const core::JointVector& q) {
  for (const core::Leg leg : core::kAllLegs) {
    for (const core::Joint joint :
         {core::Joint::hip_pitch, core::Joint::knee, core::Joint::ankle}) {
      const JointRange range = joint_range(robot, leg, joint);
      const double angle = q(core::joint_index(leg, joint));
      if (angle < range.lower || angle > range.upper) return false;
    }
  }
  return true;
}

}  // namespace

StandPosture StandPosture::load(const core::ConfigReader& section) {
  StandPosture posture;
  posture.com_height = section.number("com_height_m", core::Range::closed(0.25, 0.55));
  posture.com_x = section.number("com_ahead_of_sole_centre_m", core::Range::closed(-0.05, 0.05));
  posture.trunk_pitch = section.number("trunk_pitch_rad", core::Range::closed(-0.5, 0.8));
  section.finish();
  return posture;
}

std::optional<LinkArray<double>> links_from_com(const PlanarDynamics& dynamics,
                                                const PlanarVector<double>& com,
                                                const LinkArray<double>& known) {
  const auto share = [&](std::size_t link, double pitch) {
    const PlanarVector<double> e = dynamics.com_share(link);
    return PlanarDynamics::turned(e.x, e.z, pitch);
  };
  const PlanarVector<double> foot = share(kFoot, known[kFoot]);
  const PlanarVector<double> trunk = share(kTrunk, known[kTrunk]);
  // What shank and thigh have to span: two sides of a triangle whose third side is given.
  const double x = com.x - foot.x - trunk.x;
  const double z = com.z - foot.z - trunk.z;
  const PlanarVector<double> e_shank = dynamics.com_share(kShank);
  const PlanarVector<double> e_thigh = dynamics.com_share(kThigh);
  const double shank = std::hypot(e_shank.x, e_shank.z);
  const double thigh = std::hypot(e_thigh.x, e_thigh.z);
  const double span = std::hypot(x, z);
  const double cosine = (span * span + shank * shank - thigh * thigh) / (2.0 * span * shank);
  if (!(span > 0.0) || !(std::abs(cosine) <= 1.0)) return std::nullopt;
  const double direction = std::atan2(x, z);
  const double shank_direction = direction - std::acos(cosine);  // knee behind the line
  const double thigh_direction =
      std::atan2(x - shank * std::sin(shank_direction), z - shank * std::cos(shank_direction));
  LinkArray<double> pitch = known;
  pitch[kShank] = shank_direction - std::atan2(e_shank.x, e_shank.z);
  pitch[kThigh] = thigh_direction - std::atan2(e_thigh.x, e_thigh.z);
  return pitch;
}

std::optional<StandPose> stand_pose(const RobotParameters& robot, const StandPosture& posture) {
  const PlanarChain chain = lump_legs(robot);
  const PlanarDynamics dynamics(chain);
  const PlanarVector<double> com{posture.com_x + robot.sole_centre(),
                                 posture.com_height - chain.sole_height};
  const std::optional<LinkArray<double>> pitch =
      links_from_com(dynamics, com, {0.0, 0.0, 0.0, posture.trunk_pitch});
  if (!pitch) return std::nullopt;
  StandPose pose;
  pose.q = joint_vector(joints_from_links(*pitch));
  if (!within_ranges(robot, pose.q)) return std::nullopt;
  const PlanarVector<double> trunk = dynamics.trunk_origin(*pitch);
  pose.pitch = *pitch;
  pose.trunk_height = trunk.z + chain.sole_height;
  pose.trunk_x = trunk.x - robot.sole_centre();
  pose.trunk_pitch = posture.trunk_pitch;
  return pose;
}

}  // namespace hopscotch::model
