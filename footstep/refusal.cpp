#include "footstep/refusal.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>
#include <string>

namespace hopscotch::footstep {

using core::EdgeKind;
using core::Reason;
using core::Refusal;

namespace {

/// The first foothold that is safe in itself but cannot be reached for the given reason.
std::optional<Foothold> first_unreached(const std::vector<JudgedFoothold>& judged, Reason why) {
  for (const JudgedFoothold& place : judged) {
    if (place.foothold.why == Reason::none && place.why == why) return place.foothold;
  }
  return std::nullopt;
}

bool any_with(const std::vector<JudgedFoothold>& judged, Reason why) {
  return std::any_of(judged.begin(), judged.end(),
                     [why](const JudgedFoothold& place) { return place.foothold.why == why; });
}

/// The edge ahead behind which no support is known.
std::optional<core::TerrainEdge> end_of_support(const core::OneStepTerrain& terrain) {
  for (std::size_t i = 0; i < terrain.edge_count; ++i) {
    const core::TerrainEdge& edge = terrain.edges[i];
    const bool open = edge.kind == EdgeKind::gap_near && std::isnan(edge.step);
    if (edge.x > 0.0 && open) return edge;
  }
  return std::nullopt;
}

std::optional<core::TerrainGap> gap_before(const core::OneStepTerrain& terrain, double x) {
  for (std::size_t i = 0; i < terrain.gap_count; ++i) {
    if (terrain.gaps[i].near_x > 0.0 && terrain.gaps[i].far_x <= x) return terrain.gaps[i];
  }
  return std::nullopt;
}

std::string too_high(const FootstepConfig& config, const Foothold& place) {
  const double climb = config.reach.height.back();
  return place.height > climb
             ? "it is " + in_cm(place.height) + " high, a jump climbs " + in_cm(climb)
             : "the way leads over something higher than " +
                   in_cm(std::max(0.0, place.height) + config.reach.hurdle_max);
}

std::string too_low(const FootstepConfig& config) {
  return "something hangs over the way there, within " + in_cm(config.reach.head_room) +
         " of the ground";
}

Refusal too_far(const FootstepConfig& config, const core::OneStepTerrain& terrain,
                const Foothold& place) {
  const std::string reach =
      "a jump reaches " + in_cm(reach_at(config.reach, place.height).distance_max);
  const std::optional<core::TerrainGap> gap = gap_before(terrain, place.placement.x);
  if (gap) {
    return {Reason::gap_too_wide, "the gap ahead is " + in_cm(gap->far_x - gap->near_x) +
                                      " wide, the first safe place behind it " +
                                      in_cm(place.placement.x) + " away; " + reach};
  }
  return {Reason::out_of_reach, "the first safe place ahead is " + in_cm(place.placement.x) +
                                    " away and " + in_cm(place.height) + " high; " + reach};
}

/// What the ground itself lacks, when no safe place was found on it.
Refusal nothing_to_stand_on(const FootstepConfig& config, const core::OneStepTerrain& terrain,
                            const std::vector<JudgedFoothold>& judged) {
  if (any_with(judged, Reason::tread_too_short)) {
    return {Reason::tread_too_short, "no tread ahead is long enough for the feet and a margin of " +
                                         in_cm(config.foothold.margin_min) + " at toe and heel"};
  }
  const bool unseen = judged.empty() || any_with(judged, Reason::terrain_unseen);
  if (unseen) {
    char share[64];
    std::snprintf(share, sizeof share, "%.0f %% of the ground ahead has been seen",
                  100.0 * terrain.coverage);
    return {Reason::terrain_unseen, share};
  }
  return {Reason::no_safe_target, "the ground ahead is too rough, too steep or too close to edges"};
}

/// Which rule of the reach table stands against a jump, the first that does.
std::string beyond_reach(const ReachConfig& config, const Leap& leap) {
  const Reach reach = reach_at(config, leap.height);
  const std::string distance = in_cm(leap.distance);
  if (leap.distance < reach.distance_min) {
    return distance + " is too near; the shortest jump is " + in_cm(reach.distance_min);
  }
  if (leap.distance > reach.distance_max) {
    return distance + " is too far; a jump to that height reaches " + in_cm(reach.distance_max);
  }
  if (std::isinf(leap.takeoff_edge)) return "no edge to jump down from is seen on the way";
  const std::string down = "a jump down by " + in_cm(-leap.height);
  if (leap.takeoff_edge > reach.takeoff_edge_max) {
    return down + " starts at most " + in_cm(reach.takeoff_edge_max) +
           " before the edge, which is " + in_cm(leap.takeoff_edge) + " ahead";
  }
  return down + " lands at least " + in_cm(reach.past_edge_min) + " beyond the edge, which is " +
         in_cm(leap.takeoff_edge) + " ahead; " + distance + " is too near";
}

}  // namespace

std::string in_cm(double length) {
  char text[32];
  std::snprintf(text, sizeof text, "%.1f cm", 100.0 * length);
  return text;
}

Refusal explain_refusal(const FootstepConfig& config, const core::OneStepTerrain& terrain,
                        const std::vector<JudgedFoothold>& judged) {
  if (const auto place = first_unreached(judged, Reason::no_safe_target)) {
    return {Reason::no_safe_target,
            "the next safe place is " + in_cm(place->placement.x) + " away; " + too_low(config)};
  }
  if (const auto place = first_unreached(judged, Reason::step_too_high)) {
    return {Reason::step_too_high, "the next safe place is " + in_cm(place->placement.x) +
                                       " away; " + too_high(config, *place)};
  }
  if (const auto place = first_unreached(judged, Reason::out_of_reach)) {
    return too_far(config, terrain, *place);
  }
  const std::optional<core::TerrainEdge> end = end_of_support(terrain);
  if (end && end->x < longest_reach(config.reach)) {
    return {Reason::gap_too_wide,
            "support ends " + in_cm(end->x) + " ahead and nothing to stand on is seen behind it"};
  }
  if (const auto place = first_unreached(judged, Reason::step_too_low)) {
    return {Reason::step_too_low, "the next safe place is " + in_cm(-place->height) +
                                      " lower; a jump goes down " +
                                      in_cm(-config.reach.height.front())};
  }
  if (const auto place = first_unreached(judged, Reason::terrain_unseen)) {
    return {Reason::terrain_unseen, "the ground on the way to the next safe place, " +
                                        in_cm(place->placement.x) + " away, has not been seen"};
  }
  return nothing_to_stand_on(config, terrain, judged);
}

Refusal explain_place(const FootstepConfig& config, const JudgedFoothold& judged,
                      const Leap& leap) {
  const Foothold& place = judged.foothold;
  const std::string where = "at " + in_cm(place.placement.x);
  switch (judged.why) {
    case Reason::terrain_unseen:
      return {judged.why, where + " or on the way there the ground has not been seen"};
    case Reason::step_too_high: return {judged.why, where + ": " + too_high(config, place)};
    case Reason::step_too_low:
      return {judged.why, where + " the ground is " + in_cm(-place.height) +
                              " lower; a jump goes down " + in_cm(-config.reach.height.front())};
    case Reason::out_of_reach: return {judged.why, beyond_reach(config.reach, leap)};
    case Reason::tread_too_short:
    case Reason::no_safe_target:
      if (place.why == Reason::none) return {judged.why, where + ": " + too_low(config)};
      if (place.supported) {
        return {judged.why, where + " toe and heel are " + in_cm(place.toe_margin) + " and " +
                                in_cm(place.heel_margin) + " from edges; " +
                                in_cm(config.foothold.margin_min) + " are needed"};
      }
      return {judged.why, where + " no flat ground bears both feet"};
    default: return {judged.why, where};
  }
}

}  // namespace hopscotch::footstep
