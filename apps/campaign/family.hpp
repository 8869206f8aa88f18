#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "apps/campaign/factor.hpp"
#include "core/config_reader.hpp"
#include "sim/scenario.hpp"

namespace hopscotch::apps::campaign {

/// A kind of terrain whose sizes are drawn anew for each trial.
enum class Family : std::uint8_t {
  flat,            ///< Level ground, so many jumps of about one length.
  leap,            ///< One jump of about one length, up or down where the ground changes height.
  steps,           ///< Treads without gaps, each higher or lower than the one before.
  gaps,            ///< Level treads with gaps between them.
  stones,          ///< Treads with gaps, each at its own height about the ground's.
  stairs,          ///< Treads without gaps, all with the same rise.
  rising_boxes,    ///< Treads with gaps that rise.
  slopes,          ///< Ramps and level treads in turn.
  side_slopes,     ///< Treads that slope across the way, with gaps between them, and level ones in
                   ///< turn.
  steps_and_gaps,  ///< Treads with gaps, each higher or lower than the one before.
  mixture,         ///< Each tread comes after a gap, a step, both or a ramp, as drawn.
  jump_down,       ///< From a block down to level ground.
  drops,           ///< Released above level ground; complete when it stands.
};
[[nodiscard]] std::string_view family_name(Family family);

/// A terrain family as a campaign file asks for it.
struct FamilySpec {
  Family family = Family::flat;
  int treads = 1;  ///< Landings after the start; the last tread is long.
  int jumps = 1;   ///< Of family `flat`.
};

/// Gives the drawn size `name` (e.g. "gap_m") of the tread `element`, counted from 0.
using SizeDraw = std::function<double(std::string_view name, int element)>;

/// Reads a `scenario: {family: ...}` mapping. What can be drawn is appended to `factors`; sizes
/// that are not given take their defaults.
/// @throws core::ConfigError with file, line, key, value and rule.
[[nodiscard]] FamilySpec read_family(const FactorSection& section, std::vector<Factor>& factors);

/// Terrain, start and goal of one trial. Everything else has the scenario's defaults.
[[nodiscard]] sim::Scenario family_scenario(const FamilySpec& family, const SizeDraw& size);

/// Whether the smaller value of a size is the harder one for a family (treads, distances to an
/// edge), so that a trial is told by its smallest and not by its largest draw.
[[nodiscard]] bool smaller_is_harder(std::string_view size);

}  // namespace hopscotch::apps::campaign
