#include "footstep/step_graph.hpp"

#include <algorithm>
#include <cmath>

#include "footstep/reachability.hpp"

namespace hopscotch::footstep {

using core::CellState;
using core::Reason;
using core::TerrainProfile;

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

struct Edge {
  std::size_t to = 0;
  double cost = 0.0;
};

/// Possible jumps from each safe foothold.
std::vector<std::vector<Edge>> possible_jumps(const StepRules& rules,
                                              const std::vector<Foothold>& footholds) {
  const double longest = longest_reach(rules.config.reach);
  std::vector<std::vector<Edge>> jumps(footholds.size());
  for (std::size_t i = 0; i < footholds.size(); ++i) {
    if (footholds[i].why != Reason::none) continue;
    Takeoff from = takeoff_from(footholds[i], rules.half_length);
    from.edge += rules.config.reach.takeoff_edge_reserve;
    for (std::size_t j = i + 1; j < footholds.size(); ++j) {
      if (footholds[j].placement.x - from.x > longest) break;
      if (step_verdict(rules, from, footholds[j]) != Reason::none) continue;
      jumps[i].push_back({j, step_cost(rules, from, footholds[j])});
    }
  }
  return jumps;
}

/// Length of the longest run of samples in one state between two places [m].
double longest_run(const TerrainProfile& profile, CellState state, double from_x, double to_x) {
  int longest = 0;
  int run = 0;
  for (int i = TerrainProfile::sample(from_x); i <= TerrainProfile::sample(to_x); ++i) {
    run = profile.state[static_cast<std::size_t>(i)] == state ? run + 1 : 0;
    longest = std::max(longest, run);
  }
  return longest * TerrainProfile::kStep;
}

/// Cost of going on where no foothold is known yet: a tread may be there that has not been seen.
double unknown_cost(const StepRules& rules, const Takeoff& from) {
  const FootstepConfig& config = rules.config;
  const double foot = rules.half_length + config.foothold.margin_min;
  const double first = from.x + shortest_reach(config.reach) - foot;
  const double last = from.x + longest_reach(config.reach) + foot;
  const TerrainProfile& profile = rules.profile.profile;
  const bool beyond = last - 2.0 * foot > TerrainProfile::x(TerrainProfile::kSamples - 1);
  if (beyond || longest_run(profile, CellState::never_seen, first, last) >= 2.0 * foot) {
    return config.preference.unseen_cost;
  }
  if (longest_run(profile, CellState::occluded, first, last) >= 2.0 * foot) {
    return config.preference.hidden_cost;
  }
  return config.preference.dead_end_cost;
}

/// Whether the trunk would meet something that hangs. What is about as high as the ground belongs
/// to it.
bool is_blocked(const StepRules& rules, double ground, double from_x, double to_x) {
  constexpr double kGround = 0.15;  // [m]
  return std::any_of(rules.overhead.begin(), rules.overhead.end(), [&](const Overhead& thing) {
    const double above = thing.bottom - ground;
    return thing.x > from_x && thing.x < to_x && above > kGround &&
           above < rules.config.reach.head_room;
  });
}

}  // namespace

Takeoff takeoff_from(const Foothold& foothold, double half_length) {
  const bool goes_on = foothold.toe_margin >= kMarginSearch;
  const double edge = foothold.placement.x + half_length + foothold.toe_margin;
  return {.x = foothold.placement.x, .height = foothold.height, .edge = goes_on ? kInfinity : edge};
}

Leap leap_to(const Takeoff& from, const Foothold& to) {
  return {.distance = to.placement.x - from.x,
          .height = to.height - from.height,
          .takeoff_edge = from.edge - from.x};
}

Reason step_verdict(const StepRules& rules, const Takeoff& from, const Foothold& to) {
  const Reason reach = reach_verdict(rules.config.reach, leap_to(from, to));
  if (reach != Reason::none) return reach;
  const double start = from.x + rules.half_length;
  const double end = to.placement.x + rules.half_length;
  if (!rules.profile.is_bounded(start, end)) return Reason::terrain_unseen;
  const double ground = std::max(from.height, to.height);
  if (is_blocked(rules, ground, from.x, end)) return Reason::no_safe_target;
  const double allowed = ground + rules.config.reach.hurdle_max;
  return rules.profile.highest(start, end) > allowed ? Reason::step_too_high : Reason::none;
}

double step_cost(const StepRules& rules, const Takeoff& from, const Foothold& to) {
  const PreferenceConfig& preference = rules.config.preference;
  const double off_nominal = to.placement.x - from.x - preference.nominal_distance;
  const double overshoot = to.placement.x - rules.goal_x;
  // The last jump may be short: what counts is to stop right behind the goal.
  const double distance_cost =
      overshoot >= 0.0 ? std::max(0.0, off_nominal) + overshoot : std::abs(off_nominal);
  // Ground that lies higher or lower than it seems is met earlier or later, and moves the landing
  // by about as much.
  const double margin_wanted = preference.margin_wanted + rules.height_doubt;
  const double short_margin = std::max(0.0, margin_wanted - to.margin());
  return preference.step_cost + distance_cost + preference.margin_weight * short_margin;
}

std::vector<double> continuation_costs(const StepRules& rules,
                                       const std::vector<Foothold>& footholds) {
  const PreferenceConfig& preference = rules.config.preference;
  const std::vector<std::vector<Edge>> jumps = possible_jumps(rules, footholds);
  std::vector<double> unknown(footholds.size(), kInfinity);
  std::vector<double> cost(footholds.size(), kInfinity);
  for (std::size_t i = 0; i < footholds.size(); ++i) {
    if (footholds[i].why != Reason::none) continue;
    cost[i] = 0.0;
    unknown[i] = unknown_cost(rules, takeoff_from(footholds[i], rules.half_length));
  }
  for (int depth = 1; depth < preference.look_ahead; ++depth) {
    std::vector<double> next(footholds.size(), kInfinity);
    for (std::size_t i = 0; i < footholds.size(); ++i) {
      if (footholds[i].why != Reason::none) continue;
      next[i] = unknown[i];
      for (const Edge& jump : jumps[i]) {
        next[i] = std::min(next[i], jump.cost + preference.discount * cost[jump.to]);
      }
      if (footholds[i].placement.x >= rules.goal_x) next[i] = 0.0;
    }
    cost = next;
  }
  return cost;
}

}  // namespace hopscotch::footstep
