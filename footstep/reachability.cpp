#include "footstep/reachability.hpp"

#include <algorithm>

namespace hopscotch::footstep {

using core::Reason;

Reach reach_at(const ReachConfig& config, double height) {
  const std::vector<double>& rows = config.height;
  const double clamped = std::clamp(height, rows.front(), rows.back());
  std::size_t above = 1;
  while (above + 1 < rows.size() && rows[above] < clamped) ++above;
  const std::size_t below = above - 1;
  const double span = rows[above] - rows[below];
  const double share = span > 0.0 ? (clamped - rows[below]) / span : 0.0;
  const auto between = [&](const std::vector<double>& column) {
    return column[below] + share * (column[above] - column[below]);
  };
  return {.distance_min = between(config.distance_min),
          .distance_max = between(config.distance_max),
          .takeoff_edge_max = between(config.takeoff_edge_max),
          .past_edge_min = between(config.past_edge_min)};
}

Reason reach_verdict(const ReachConfig& config, const Leap& leap) {
  if (leap.height > config.height.back()) return Reason::step_too_high;
  if (leap.height < config.height.front()) return Reason::step_too_low;
  const Reach reach = reach_at(config, leap.height);
  if (!(leap.distance >= reach.distance_min && leap.distance <= reach.distance_max)) {
    return Reason::out_of_reach;
  }
  if (leap.height >= -config.drop_min) return Reason::none;
  const bool clears = leap.takeoff_edge <= reach.takeoff_edge_max &&
                      leap.distance - leap.takeoff_edge >= reach.past_edge_min;
  return clears ? Reason::none : Reason::out_of_reach;
}

double longest_reach(const ReachConfig& config) {
  return *std::max_element(config.distance_max.begin(), config.distance_max.end());
}

double shortest_reach(const ReachConfig& config) {
  return *std::min_element(config.distance_min.begin(), config.distance_min.end());
}

}  // namespace hopscotch::footstep
