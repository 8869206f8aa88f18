#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

#include "core/one_step_terrain.hpp"
#include "core/reason.hpp"
#include "core/robot_layout.hpp"
#include "core/robot_state.hpp"

namespace hopscotch::core {

/// Who asked for a landing place.
enum class TargetSource : std::uint8_t { perception, truth, operator_override };

constexpr std::string_view target_source_name(TargetSource source) {
  switch (source) {
    case TargetSource::perception: return "perception";
    case TargetSource::truth: return "truth";
    case TargetSource::operator_override: return "operator";
  }
  return "perception";
}

/// Where the next jump is to land.
struct LandingTarget {
  std::array<Eigen::Isometry3d, kLegs> X_WF{Eigen::Isometry3d::Identity(),
                                            Eigen::Isometry3d::Identity()};  ///< Soles at rest.
  Eigen::Vector3d p_WS = Eigen::Vector3d::Constant(kNaN);  ///< Take-off frame S: origin in W [m].
  double heading = kNaN;                                   ///< Yaw of S in W [rad].
  double distance = kNaN;  ///< Along x of S, mid-point to mid-point of the soles [m].
  double height = kNaN;    ///< Of the landing soles above S [m].
  double margin = kNaN;    ///< Smallest distance from toe or heel to an edge [m].
  double safe_probability = kNaN;
  TargetSource source = TargetSource::perception;
  TerrainProfile profile;  ///< In S; the planner keeps clear of `upper`.
};

/// A place that was looked at and not chosen.
struct RejectedTarget {
  double distance = kNaN;  ///< In S [m].
  Reason why = Reason::none;
};

/// A place that would do, with the numbers it was ranked by.
struct RankedTarget {
  double distance = kNaN;  ///< In S [m].
  double height = kNaN;    ///< In S [m].
  double margin = kNaN;    ///< Smallest distance from toe or heel to an edge [m].
  double tread = kNaN;     ///< Length of the support it lies on [m].
  double safe_probability = kNaN;
};

/// The decision of `footstep`: the best target or none, and why not the others.
struct TargetChoice {
  static constexpr std::size_t kMaxCandidates = 64;

  Stamp stamp;
  std::optional<LandingTarget> target;
  Refusal refusal;  ///< Set when there is no target.
  std::array<RankedTarget, kMaxCandidates> ranked{};
  std::size_t ranked_count = 0;
  std::array<RejectedTarget, kMaxCandidates> rejected{};
  std::size_t rejected_count = 0;
};

}  // namespace hopscotch::core
