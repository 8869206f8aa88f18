#include "apps/campaign/family.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

namespace hopscotch::apps::campaign {

using core::ConfigReader;
using core::Range;

namespace {

constexpr double kBehind = 1.0;        // ground behind the start [m]
constexpr double kLastTread = 3.0;     // length of the last tread [m]
constexpr double kBeyondEdge = 0.005;  // heels so far beyond the last edge reach the goal [m]
constexpr double kPitDepth = 0.5;      // below the lowest tread [m]
constexpr int kMostTreads = 100;
constexpr int kMostJumps = 1000;  // on level ground

/// A size that a family has, with its default.
struct Size {
  std::string_view name;
  Range range;
  double fallback;
};

const Size kEdge{"edge_m", Range::closed(0.10, 5.0), 0.175};
const Size kGap{"gap_m", Range::closed(0.0, 1.0), 0.10};
const Size kStep{"step_m", Range::closed(-0.4, 0.4), 0.0};
const Size kRise{"rise_m", Range::closed(-0.4, 0.4), 0.10};
const Size kTread{"tread_m", Range::closed(0.16, 10.0), 0.35};
const Size kSlope{"slope_rad", Range::closed(-0.4, 0.4), 0.08};
const Size kDrop{"drop_m", Range::closed(0.0, 1.0), 0.25};
const Size kLateral{"lateral_m", Range::closed(-0.3, 0.3), 0.0};
const Size kYaw{"yaw_rad", Range::closed(-0.5, 0.5), 0.0};
/// Up to the farthest that footstep chooses (`footstep.reach`).
const Size kJump{"jump_m", Range::closed(0.06, 0.55), 0.40};

struct FamilyRule {
  Family family;
  std::string_view name;
  int treads;
  std::vector<Size> sizes;
};

Size with(Size size, double fallback) {
  size.fallback = fallback;
  return size;
}

const std::vector<FamilyRule>& family_rules() {
  static const std::vector<FamilyRule> rules{
      {Family::flat, "flat", 0, {kJump, kLateral, kYaw}},
      {Family::leap, "leap", 0, {kJump, with(kEdge, 0.13), kStep}},
      {Family::steps, "steps", 6, {kEdge, kStep, with(kTread, 0.40)}},
      {Family::gaps, "gaps", 6, {kEdge, kGap, kTread}},
      {Family::stones, "stones", 6, {kEdge, with(kGap, 0.20), kStep, with(kTread, 0.25)}},
      {Family::stairs, "stairs", 4, {kEdge, kRise, with(kTread, 0.40)}},
      {Family::rising_boxes, "rising-boxes", 3, {kEdge, kGap, with(kStep, 0.06), kTread}},
      {Family::slopes, "slopes", 4, {kEdge, kSlope, with(kTread, 0.60)}},
      {Family::side_slopes,
       "side-slopes",
       4,
       {kEdge, with(kGap, 0.05), kSlope, with(kTread, 0.60)}},
      {Family::steps_and_gaps, "steps-and-gaps", 6, {kEdge, kGap, kStep, kTread}},
      {Family::mixture, "random-mixture", 6, {kEdge, kGap, kStep, kSlope, kTread}},
      {Family::jump_down, "jump-down", 0, {with(kEdge, 0.52), kDrop}},
      {Family::drops, "drops", 0, {kDrop}},
  };
  return rules;
}

const FamilyRule& rule_of(Family family) {
  return *std::find_if(family_rules().begin(), family_rules().end(),
                       [&](const FamilyRule& rule) { return rule.family == family; });
}

Factor fixed_factor(const Size& size) {
  Factor factor;
  factor.name = size.name;
  factor.values = {size.fallback};
  factor.labels = {exact_text(size.fallback)};
  return factor;
}

sim::Slab slab(double begin, double end, double top) {
  constexpr double kHalfWidth = 0.6;
  sim::Slab result;
  result.centre = {0.5 * (begin + end), 0.0};
  result.half_size = {0.5 * (end - begin), kHalfWidth};
  result.top = top;
  return result;
}

/// What lies before a tread.
struct Approach {
  double gap = 0.0;     // [m]
  double step = 0.0;    // [m]
  double slope = 0.0;   // of the tread itself [rad]
  double across = 0.0;  // of the tread itself, + rising to the left [rad]
};

/// The obstacle of one tread of a mixture: each kind as likely as the others.
Approach mixed_approach(const SizeDraw& size, int i) {
  enum Kind { gap, step, both, ramp };
  const auto kind = static_cast<Kind>(std::min(3, static_cast<int>(4.0 * size("mixture", i))));
  Approach approach;
  if (kind == gap || kind == both) approach.gap = size("gap_m", i);
  if (kind == step || kind == both) approach.step = size("step_m", i);
  if (kind == ramp) approach.slope = size("slope_rad", i);
  return approach;
}

Approach approach_of(const FamilySpec& spec, const SizeDraw& size, int i) {
  switch (spec.family) {
    case Family::steps: return {.gap = 0.0, .step = size("step_m", i)};
    case Family::gaps: return {.gap = size("gap_m", i)};
    case Family::stones: {
      const double before = i == 0 ? 0.0 : size("step_m", i - 1);
      return {.gap = size("gap_m", i), .step = size("step_m", i) - before};
    }
    case Family::stairs: return {.gap = 0.0, .step = size("rise_m", 0)};
    case Family::rising_boxes:
    case Family::steps_and_gaps: return {.gap = size("gap_m", i), .step = size("step_m", i)};
    case Family::slopes: {
      Approach approach;
      if (i % 2 == 0) approach.slope = size("slope_rad", i);
      return approach;
    }
    case Family::side_slopes: {
      Approach approach;
      approach.gap = size("gap_m", i);
      if (i % 2 == 0) approach.across = size("slope_rad", i);
      return approach;
    }
    case Family::mixture: return mixed_approach(size, i);
    case Family::flat:
    case Family::leap:
    case Family::jump_down:
    case Family::drops: break;
  }
  return {};
}

/// The slab turned by a quarter, so that it rises to the left; its middle keeps its height.
void lean_across(double slope, sim::Slab& slab) {
  std::swap(slab.half_size.x(), slab.half_size.y());
  slab.yaw = 0.5 * std::numbers::pi;
  slab.slope = slope;
  slab.top -= slab.half_size.x() * std::tan(slope);
}

/// Tread after tread from the first edge on. The last one is long and level.
sim::Scenario chain(const FamilySpec& spec, const SizeDraw& size) {
  sim::Scenario scenario;
  double x = size("edge_m", 0);
  double top = 0.0;
  double lowest = 0.0;
  scenario.seen.slabs.push_back(slab(-kBehind, x, 0.0));
  for (int i = 0; i < spec.treads; ++i) {
    const bool last = i + 1 == spec.treads;
    Approach approach = approach_of(spec, size, i);
    if (last) approach.slope = approach.across = 0.0;
    const double length = last ? kLastTread : size("tread_m", i);
    x += approach.gap;
    top += approach.step;
    sim::Slab tread = slab(x, x + length, top);
    tread.slope = approach.slope;
    if (approach.across != 0.0) lean_across(approach.across, tread);
    scenario.seen.slabs.push_back(tread);
    if (last) scenario.goal.x = x + kBeyondEdge;
    x += length;
    lowest = std::min({lowest, tread.lowest(), tread.highest()});
    top += length * std::tan(approach.slope);
  }
  scenario.seen.pit_depth = kPitDepth - lowest;
  return scenario;
}

sim::Scenario jump_down(const SizeDraw& size) {
  const double edge = size("edge_m", 0);
  sim::Scenario scenario;
  scenario.seen.slabs = {slab(-kBehind, edge, size("drop_m", 0)),
                         slab(edge, edge + kLastTread, 0.0)};
  scenario.goal.x = edge + kBeyondEdge;
  return scenario;
}

/// Jumps to the side or with a turn are asked for; straight ones the robot chooses itself.
std::vector<core::TargetOverride> side_targets(const FamilySpec& spec, const SizeDraw& size) {
  std::vector<core::TargetOverride> targets;
  bool straight = true;
  for (int i = 0; i < spec.jumps; ++i) {
    core::TargetOverride target;
    target.distance = size("jump_m", i);
    target.lateral = size("lateral_m", i);
    target.yaw = size("yaw_rad", i);
    straight = straight && target.lateral == 0.0 && target.yaw == 0.0;
    targets.push_back(target);
  }
  if (straight) targets.clear();
  return targets;
}

sim::Scenario level_ground(const FamilySpec& spec) {
  constexpr double kRoomPerJump = 1.2;  // more than any jump covers [m]
  sim::Scenario scenario;
  constexpr double kDriftPerJump = 0.1;  // headings drift, and so do long chains [m]
  scenario.seen.slabs = {slab(-kBehind, 2.0 + kRoomPerJump * spec.jumps, 0.0)};
  scenario.seen.slabs[0].half_size.y() += kDriftPerJump * (spec.jumps - 1);
  scenario.goal.jumps = spec.jumps;
  return scenario;
}

sim::Scenario leap(const SizeDraw& size) {
  const double edge = size("edge_m", 0);
  sim::Scenario scenario;
  scenario.seen.slabs = {slab(-kBehind, edge, 0.0),
                         slab(edge, edge + kLastTread, size("step_m", 0))};
  scenario.seen.pit_depth = kPitDepth - std::min(0.0, size("step_m", 0));
  scenario.goal.jumps = 1;
  return scenario;
}

sim::Scenario drop(const SizeDraw& size) {
  sim::Scenario scenario = level_ground({});
  scenario.start.drop = size("drop_m", 0);
  // Behind the start: reached as soon as the robot stands still.
  scenario.goal = {.x = -0.5 * kBehind, .jumps = std::nullopt};
  return scenario;
}

}  // namespace

std::string_view family_name(Family family) {
  return rule_of(family).name;
}

FamilySpec read_family(const FactorSection& section, std::vector<Factor>& factors) {
  const ConfigReader& reader = section.reader;
  std::vector<std::string> names;
  for (const FamilyRule& rule : family_rules()) names.emplace_back(rule.name);
  const FamilyRule& rule = family_rules()[static_cast<std::size_t>(reader.choice("family", names))];
  FamilySpec spec{.family = rule.family, .treads = rule.treads, .jumps = 1};
  if (rule.treads > 0) spec.treads = reader.integer_or("treads", rule.treads, 1, kMostTreads);
  if (rule.family == Family::flat) spec.jumps = reader.integer_or("jumps", 1, 1, kMostJumps);
  for (const Size& size : rule.sizes) {
    const FactorRule factor_rule{.name = size.name, .range = size.range};
    factors.push_back(reader.has(size.name) ? read_factor(section, factor_rule)
                                            : fixed_factor(size));
  }
  reader.finish();
  return spec;
}

sim::Scenario family_scenario(const FamilySpec& family, const SizeDraw& size) {
  sim::Scenario scenario;
  switch (family.family) {
    case Family::flat:
      scenario = level_ground(family);
      scenario.targets = side_targets(family, size);
      if (!scenario.targets.empty()) scenario.seen.slabs[0].half_size.y() += kLastTread;
      break;
    case Family::leap: scenario = leap(size); break;
    case Family::jump_down: scenario = jump_down(size); break;
    case Family::drops: scenario = drop(size); break;
    default: scenario = chain(family, size); break;
  }
  scenario.name = family_name(family.family);
  return scenario;
}

bool smaller_is_harder(std::string_view size) {
  return size == kTread.name || size == kEdge.name;
}

}  // namespace hopscotch::apps::campaign
