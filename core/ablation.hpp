#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

namespace hopscotch::core {

/// What of the method is left out, for comparison with the source paper and with less.
enum class Ablation : std::uint8_t {
  none,
  fixed_frequency,  ///< The MPC's knots are all as long, whatever the plan's are.
  no_landing_plan,  ///< From touchdown on the final posture is the only reference.
  paper_takeoff,    ///< Takeoff by joint PD and the MPC's wrenches alone, as eq. (15) has it.
  srbd_only,        ///< Plan and tracking by one rigid body.
};

inline constexpr std::array<std::string_view, 5> kAblationNames{
    "none", "fixed-frequency", "no-landing-plan", "paper-takeoff", "srbd-only"};

constexpr std::string_view ablation_name(Ablation ablation) {
  return kAblationNames[static_cast<std::size_t>(ablation)];
}

/// Nothing if there is no such name.
constexpr std::optional<Ablation> ablation_from_name(std::string_view name) {
  for (std::size_t i = 0; i < kAblationNames.size(); ++i) {
    if (kAblationNames[i] == name) return static_cast<Ablation>(i);
  }
  return std::nullopt;
}

}  // namespace hopscotch::core
