#include "footstep/candidates.hpp"

#include <algorithm>
#include <cmath>

#include "footstep/reachability.hpp"

namespace hopscotch::footstep {

namespace {

/// Places nearer to each other than this are one; the map cannot tell them apart.
constexpr double kSamePlace = 0.003;  // [m]
/// Places at the end of a tread keep this more than the least margin, so that they pass the test.
constexpr double kEndReserve = 0.005;  // [m]

double last_observed(const core::TerrainProfile& profile) {
  for (int i = core::TerrainProfile::kSamples - 1; i >= 0; --i) {
    if (profile.state[static_cast<std::size_t>(i)] == core::CellState::observed) {
      return core::TerrainProfile::x(i);
    }
  }
  return core::TerrainProfile::kStart;
}

void add_place(double x, std::vector<double>& places) {
  const auto same = [x](double other) { return std::abs(other - x) < kSamePlace; };
  if (std::none_of(places.begin(), places.end(), same)) places.push_back(x);
}

/// Centre and ends of the treads that the scored footholds lie on.
std::vector<double> special_places(const FootstepConfig& config,
                                   const std::vector<Foothold>& scored) {
  const double margin = config.foothold.margin_min + kEndReserve;
  std::vector<double> places;
  for (const Foothold& foothold : scored) {
    if (!foothold.supported) continue;
    const double x = foothold.placement.x;
    const bool ends = foothold.toe_margin < kMarginSearch;
    const bool begins = foothold.heel_margin < kMarginSearch;
    if (ends && begins) add_place(x + 0.5 * (foothold.toe_margin - foothold.heel_margin), places);
    if (ends) add_place(x + foothold.toe_margin - margin, places);
    if (begins) add_place(x - foothold.heel_margin + margin, places);
  }
  return places;
}

}  // namespace

std::vector<Foothold> score_candidates(const FootstepConfig& config, const StanceOnMap& stance,
                                       const core::TerrainProfile& profile, double goal_x) {
  const double first = shortest_reach(config.reach);
  const double last = last_observed(profile) - stance.half_length;
  const double spacing = config.preference.spacing;
  const double nominal = config.preference.nominal_distance;
  std::vector<Foothold> scored;
  const auto score = [&](double x) {
    if (x >= first && x <= last) {
      scored.push_back(score_foothold(config.foothold, stance, {.x = x}));
    }
  };
  for (int i = static_cast<int>(std::ceil((first - nominal) / spacing));
       nominal + i * spacing <= last; ++i) {
    score(nominal + i * spacing);
  }
  std::vector<double> places = special_places(config, scored);
  if (std::isfinite(goal_x)) add_place(goal_x, places);
  for (const double x : places) score(x);
  std::sort(scored.begin(), scored.end(),
            [](const Foothold& a, const Foothold& b) { return a.placement.x < b.placement.x; });
  return scored;
}

}  // namespace hopscotch::footstep
