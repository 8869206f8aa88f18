#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <string_view>

namespace hopscotch::core {

/// Index order of everything that exists once per leg.
enum class Leg : std::size_t { left = 0, right = 1 };

/// Index order of the joints within a leg, trunk to foot.
enum class Joint : std::size_t { hip_yaw = 0, hip_roll = 1, hip_pitch = 2, knee = 3, ankle = 4 };

inline constexpr int kLegs = 2;
inline constexpr int kJointsPerLeg = 5;
inline constexpr int kJoints = kLegs * kJointsPerLeg;

inline constexpr std::array<Leg, kLegs> kAllLegs{Leg::left, Leg::right};
inline constexpr std::array<std::string_view, kLegs> kLegNames{"left", "right"};
inline constexpr std::array<std::string_view, kJointsPerLeg> kJointNames{
    "hip_yaw", "hip_roll", "hip_pitch", "knee", "ankle"};

/// One number per joint, left leg first, `Joint` order within a leg.
using JointVector = Eigen::Vector<double, kJoints>;
/// One number per joint of a single leg, `Joint` order.
using LegVector = Eigen::Vector<double, kJointsPerLeg>;

constexpr std::size_t index(Leg leg) {
  return static_cast<std::size_t>(leg);
}
constexpr std::size_t index(Joint joint) {
  return static_cast<std::size_t>(joint);
}
/// Position of a joint in a JointVector.
constexpr int joint_index(Leg leg, Joint joint) {
  return static_cast<int>(index(leg)) * kJointsPerLeg + static_cast<int>(index(joint));
}
/// First position of a leg in a JointVector.
constexpr int leg_offset(Leg leg) {
  return static_cast<int>(index(leg)) * kJointsPerLeg;
}

}  // namespace hopscotch::core
