#include "footstep/landing_selector.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <utility>
#include <vector>

#include "footstep/candidates.hpp"
#include "footstep/foothold_score.hpp"
#include "footstep/height_doubt.hpp"
#include "footstep/reachability.hpp"
#include "footstep/refusal.hpp"
#include "footstep/step_graph.hpp"
#include "footstep/terrain_profile.hpp"
#include "model/kinematics.hpp"

namespace hopscotch::footstep {

using core::Reason;
using core::TargetChoice;

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// A candidate that can be reached, and what it costs with all that follows.
struct Ranked {
  Foothold foothold;
  double cost = 0.0;
  bool dead_end = false;  ///< No way on is seen from there.
};

double half_stance_of(const model::RobotParameters& robot, const core::RobotState& state) {
  const std::array<Eigen::Isometry3d, core::kLegs> X_WF = model::sole_poses(robot, state);
  return 0.5 * (X_WF[0].translation() - X_WF[1].translation()).head<2>().norm();
}

StanceOnMap stance_on(const SeenGround& ground, const model::RobotParameters& robot,
                      const core::RobotState& state) {
  return {.map = ground.map,
          .p_WS = ground.terrain.p_WS,
          .heading = ground.terrain.heading,
          .half_stance = half_stance_of(robot, state),
          .half_length = 0.5 * (robot.toe + robot.heel),
          .half_width = 0.5 * robot.foot_width};
}

bool is_finite(const StanceOnMap& stance) {
  return stance.p_WS.allFinite() && std::isfinite(stance.heading) &&
         std::isfinite(stance.half_stance);
}

/// Mid-point of the soles, in S, from which both heels are beyond the goal; infinity without goal.
double goal_in_S(const LandingTask& task, const StanceOnMap& stance, double goal_margin) {
  const Eigen::Vector2d goal_axis(std::cos(task.goal_heading), std::sin(task.goal_heading));
  const double progress = std::cos(stance.heading - task.goal_heading);
  if (!std::isfinite(task.goal_x) || !(progress > 0.0)) return kInfinity;
  const double ahead = task.goal_x + goal_margin - goal_axis.dot(stance.p_WS.head<2>());
  return ahead / progress + stance.half_length;
}

/// Where the present tread ends: the first edge ahead at which the ground falls away.
Takeoff present_takeoff(const core::OneStepTerrain& terrain) {
  Takeoff takeoff{.x = 0.0, .height = 0.0, .edge = kInfinity};
  for (std::size_t i = 0; i < terrain.edge_count; ++i) {
    const core::TerrainEdge& edge = terrain.edges[i];
    const bool falls = edge.kind == core::EdgeKind::gap_near || edge.kind == core::EdgeKind::down;
    if (falls && edge.x > 0.0) takeoff.edge = std::min(takeoff.edge, edge.x);
  }
  return takeoff;
}

/// What is flown over where the map may be wrong: from the edge of the present tread, or where the
/// toes are off it, to the edge of the next one, or where the heels have to come down.
JumpStretch doubted(const Foothold& foothold, const StanceOnMap& stance, const Takeoff& takeoff) {
  constexpr double kRise = 0.045;   // toes need so much way to rise [m]
  constexpr double kRunIn = 0.045;  // and heels to come down [m]
  const double heels = foothold.placement.x - stance.half_length;
  const bool edge_seen = foothold.heel_margin < kMarginSearch;
  const double margin = edge_seen ? foothold.heel_margin - core::TerrainProfile::kStep : 0.0;
  const double from_edge = std::isfinite(takeoff.edge) ? takeoff.edge : 0.0;
  return {std::max(stance.half_length + kRise, from_edge), heels - std::max(kRunIn, margin)};
}

core::LandingTarget target_at(const StepRules& rules, const StanceOnMap& stance,
                              const Takeoff& takeoff, const Foothold& foothold) {
  core::LandingTarget target;
  const Placement& place = foothold.placement;
  const Eigen::AngleAxisd in_W(stance.heading, Eigen::Vector3d::UnitZ());
  const Eigen::AngleAxisd of_feet(stance.heading + place.yaw, Eigen::Vector3d::UnitZ());
  const Eigen::Vector3d centre =
      stance.p_WS + in_W * Eigen::Vector3d(place.x, place.y, foothold.height);
  for (const core::Leg leg : core::kAllLegs) {
    const double side = leg == core::Leg::left ? stance.half_stance : -stance.half_stance;
    Eigen::Isometry3d& X_WF = target.X_WF[core::index(leg)];
    X_WF.linear() = of_feet.toRotationMatrix();
    X_WF.translation() = centre + of_feet * Eigen::Vector3d(0.0, side, side * foothold.rise_across);
  }
  target.p_WS = stance.p_WS;
  target.heading = stance.heading;
  target.distance = place.x;
  target.height = foothold.height;
  target.margin = foothold.margin();
  target.safe_probability = foothold.safe_probability;
  const JumpStretch flown_over = doubted(foothold, stance, takeoff);
  target.profile = rules.profile.profile;
  // Where the map is wrong under the soles it need not be wrong likewise where they will land.
  take_over(rules.mapped.profile, flown_over.end, target.profile);
  raise(flown_over, rules.height_doubt, target.profile);
  return target;
}

void list_ranked(const Foothold& foothold, double half_length, TargetChoice& choice) {
  if (choice.ranked_count >= choice.ranked.size()) return;
  choice.ranked[choice.ranked_count++] = {
      .distance = foothold.placement.x,
      .height = foothold.height,
      .margin = foothold.margin(),
      .tread = foothold.toe_margin + foothold.heel_margin + 2.0 * half_length,
      .safe_probability = foothold.safe_probability};
}

void list_rejected(const JudgedFoothold& judged, TargetChoice& choice) {
  if (choice.rejected_count >= choice.rejected.size()) return;
  choice.rejected[choice.rejected_count++] = {judged.foothold.placement.x, judged.why};
}

/// What sticks out of the ground under a sole makes it no place to stand, however flat the rest.
void look_under_soles(const StepRules& rules, Foothold& foothold) {
  if (foothold.why != Reason::none) return;
  if (rules.mapped.carries(foothold.placement.x, rules.half_length, foothold.height)) return;
  foothold.why = Reason::no_safe_target;
  foothold.supported = false;
}

std::vector<JudgedFoothold> judge_all(const StepRules& rules, const Takeoff& takeoff,
                                      const std::vector<Foothold>& footholds) {
  std::vector<JudgedFoothold> judged;
  judged.reserve(footholds.size());
  for (Foothold foothold : footholds) {
    look_under_soles(rules, foothold);
    const Reason why =
        foothold.why != Reason::none ? foothold.why : step_verdict(rules, takeoff, foothold);
    judged.push_back({foothold, why});
  }
  return judged;
}

/// Reachable candidates, cheapest first; equal costs keep the nearer one first.
std::vector<Ranked> rank(const StepRules& rules, const Takeoff& takeoff,
                         const std::vector<JudgedFoothold>& judged,
                         const std::vector<double>& continuation) {
  const PreferenceConfig& preference = rules.config.preference;
  std::vector<Ranked> ranked;
  for (std::size_t i = 0; i < judged.size(); ++i) {
    if (judged[i].why != Reason::none) continue;
    const Foothold& foothold = judged[i].foothold;
    const double cost = step_cost(rules, takeoff, foothold) + preference.discount * continuation[i];
    const double no_way_on = std::min(preference.hidden_cost, preference.dead_end_cost);
    ranked.push_back({foothold, cost, continuation[i] >= no_way_on});
  }
  std::stable_sort(ranked.begin(), ranked.end(),
                   [](const Ranked& a, const Ranked& b) { return a.cost < b.cost; });
  return ranked;
}

/// Takes the best candidate, unless it is a short hop into a dead end.
void choose_best(const StepRules& rules, const StanceOnMap& stance,
                 const core::OneStepTerrain& terrain, core::TargetSource source,
                 TargetChoice& choice) {
  const std::vector<Foothold> footholds =
      score_candidates(rules.config, stance, terrain.profile, rules.goal_x);
  const Takeoff takeoff = present_takeoff(terrain);
  const std::vector<JudgedFoothold> judged = judge_all(rules, takeoff, footholds);
  const std::vector<Ranked> ranked =
      rank(rules, takeoff, judged, continuation_costs(rules, footholds));
  for (const Ranked& candidate : ranked) {
    list_ranked(candidate.foothold, stance.half_length, choice);
  }
  const double longest = longest_reach(rules.config.reach);
  for (const JudgedFoothold& place : judged) {
    if (place.why != Reason::none && place.foothold.placement.x <= longest) {
      list_rejected(place, choice);
    }
  }
  const bool worth_it =
      !ranked.empty() && (!ranked.front().dead_end || ranked.front().foothold.placement.x >=
                                                          rules.config.preference.dead_end_advance);
  if (worth_it) {
    choice.target = target_at(rules, stance, takeoff, ranked.front().foothold);
    choice.target->source = source;
  } else {
    choice.refusal = explain_refusal(rules.config, terrain, judged);
  }
}

/// Why a place that a person asked for is no place at all; `none` when it is one.
core::Refusal malformed(const ReachConfig& reach, const core::TargetOverride& wanted) {
  const bool finite = std::isfinite(wanted.distance) && std::isfinite(wanted.lateral) &&
                      std::isfinite(wanted.yaw) && !std::isinf(wanted.height);
  if (!finite) return {Reason::target_malformed, "distance, lateral and yaw must be numbers"};
  const double longest = longest_reach(reach);
  if (wanted.distance > longest) {
    return {Reason::out_of_reach,
            in_cm(wanted.distance) + " is farther than any jump; the longest is " + in_cm(longest)};
  }
  if (std::abs(wanted.lateral) > reach.lateral_max || std::abs(wanted.yaw) > reach.yaw_max) {
    char turn[32];
    std::snprintf(turn, sizeof turn, "%.2f rad", reach.yaw_max);
    return {Reason::out_of_reach, "a jump leads at most " + in_cm(reach.lateral_max) +
                                      " to a side and turns at most " + turn};
  }
  return {};
}

/// Judges the place that a person asked for by the same rules.
void choose_wanted(const StepRules& rules, const StanceOnMap& stance,
                   const core::OneStepTerrain& terrain, const core::TargetOverride& wanted,
                   TargetChoice& choice) {
  choice.refusal = malformed(rules.config.reach, wanted);
  if (choice.refusal.reason != Reason::none) return;
  Foothold foothold =
      score_foothold(rules.config.foothold, stance,
                     {.x = wanted.distance, .y = wanted.lateral, .yaw = wanted.yaw});
  look_under_soles(rules, foothold);
  JudgedFoothold judged{foothold, foothold.why};
  const Takeoff takeoff = present_takeoff(terrain);
  if (judged.why == Reason::none) judged.why = step_verdict(rules, takeoff, foothold);
  if (judged.why != Reason::none) {
    list_rejected(judged, choice);
    choice.refusal = explain_place(rules.config, judged, leap_to(takeoff, foothold));
    return;
  }
  const double difference = wanted.height - foothold.height;
  if (std::abs(difference) > rules.config.foothold.edge_tolerance) {  // false without a wish
    list_rejected({foothold, Reason::no_safe_target}, choice);
    choice.refusal = {Reason::no_safe_target, "the ground there is " + in_cm(foothold.height) +
                                                  " high, not " + in_cm(wanted.height)};
    return;
  }
  list_ranked(foothold, stance.half_length, choice);
  choice.target = target_at(rules, stance, takeoff, foothold);
  choice.target->source = core::TargetSource::operator_override;
}

/// What hangs within the width of the body, in S.
std::vector<Overhead> overhead_of(const SeenGround& ground, double half_width) {
  const core::OneStepTerrain& terrain = ground.terrain;
  const Eigen::Vector2d ahead(std::cos(terrain.heading), std::sin(terrain.heading));
  std::vector<Overhead> overhead;
  for (const Eigen::Vector3f& bottom : ground.hanging) {
    const Eigen::Vector3d p_S_W = bottom.cast<double>() - terrain.p_WS;
    const double y = ahead.x() * p_S_W.y() - ahead.y() * p_S_W.x();
    if (std::abs(y) > half_width) continue;
    overhead.push_back({.x = ahead.dot(p_S_W.head<2>()), .bottom = p_S_W.z()});
  }
  return overhead;
}

}  // namespace

LandingSelector::LandingSelector(const FootstepConfig& config, const model::RobotParameters& robot)
    : config_(config), robot_(robot) {}

TargetChoice LandingSelector::choose(const SeenGround& ground, const core::RobotState& state,
                                     const LandingTask& task) const {
  TargetChoice choice;
  choice.stamp = ground.terrain.stamp;
  const StanceOnMap stance = stance_on(ground, robot_, state);
  if (!is_finite(stance) || ground.map.cells.empty()) {
    choice.refusal = {Reason::terrain_unseen, "there is no map yet, or no pose to read it from"};
    return choice;
  }
  const BoundedProfile mapped = bound_profile(config_.profile, ground.terrain.profile);
  core::TerrainProfile with_soles = ground.terrain.profile;
  put_underfoot(with_soles);
  const BoundedProfile profile = bound_profile(config_.profile, with_soles);
  const std::vector<Overhead> overhead = overhead_of(ground, config_.reach.body_half_width);
  const StepRules rules{.config = config_,
                        .profile = profile,
                        .mapped = mapped,
                        .overhead = overhead,
                        .height_doubt = task.height_doubt,
                        .half_length = stance.half_length,
                        .goal_x = goal_in_S(task, stance, config_.preference.goal_margin)};
  if (task.target) {
    choose_wanted(rules, stance, ground.terrain, *task.target, choice);
  } else {
    choose_best(rules, stance, ground.terrain, task.source, choice);
  }
  return choice;
}

}  // namespace hopscotch::footstep
