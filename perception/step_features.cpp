#include "perception/step_features.hpp"

#include <algorithm>
#include <cmath>

#include "core/check.hpp"

namespace hopscotch::perception {

namespace {

using core::EdgeKind;

/// A step is a change of height within so many slices: 4.5 cm, three cells of a blurred edge.
constexpr std::size_t kStepSlices = 9;
/// Heights at the ends of a tread are averaged over so many slices: 6 cm.
constexpr std::size_t kEndSlices = 12;
/// Shorter pieces of support are what is left of an edge.
constexpr double kSplinter = 0.02;  // [m]

struct Run {
  std::size_t first = 0;
  std::size_t last = 0;
};

bool bears(const Slice& slice) {
  return slice.kind == SliceKind::level;
}

/// The slice within the last few up to `last` at which the height changes most.
std::size_t sharpest_change(const std::vector<Slice>& slices, std::size_t first, std::size_t last) {
  std::size_t best = last;
  double largest = -1.0;
  for (std::size_t i = first + 1; i <= last; ++i) {
    const double change = std::abs(slices[i].mean - slices[i - 1].mean);
    if (change <= largest) continue;
    largest = change;
    best = i;
  }
  return best;
}

/// Runs of level slices, cut at steps.
std::vector<Run> level_runs(const OneStepConfig& config, const std::vector<Slice>& slices) {
  std::vector<Run> runs;
  bool open = false;
  for (std::size_t i = 0; i < slices.size(); ++i) {
    if (!bears(slices[i])) {
      open = false;
      continue;
    }
    if (!open) {
      runs.push_back({i, i});
      open = true;
      continue;
    }
    Run& run = runs.back();
    run.last = i;
    const std::size_t back = std::max(run.first, i < kStepSlices ? 0 : i - kStepSlices);
    if (std::abs(slices[i].mean - slices[back].mean) < config.step_min) continue;
    const std::size_t cut = sharpest_change(slices, back, i);
    run.last = cut - 1;
    runs.push_back({cut, i});
  }
  return runs;
}

constexpr double kStepShare = 0.025;  // of a cell's variance, see below

/// Variance of a height averaged over the end of a tread, as far as it counts for a step: what all
/// frames share lifts both sides of a step alike, and a cell's own error averages out over the end.
double end_variance(const std::vector<Slice>& slices, const Run& run) {
  double sum = 0.0;
  for (std::size_t i = run.first; i <= run.last; ++i) sum += slices[i].variance;
  return kStepShare * sum / static_cast<double>(run.last - run.first + 1);
}

double mean_height(const std::vector<Slice>& slices, std::size_t first, std::size_t last) {
  double sum = 0.0;
  for (std::size_t i = first; i <= last; ++i) sum += slices[i].mean;
  return sum / static_cast<double>(last - first + 1);
}

Tread tread_of(const std::vector<Slice>& slices, const Run& run) {
  const std::size_t length = std::min(kEndSlices, run.last - run.first + 1);
  return {.start = slices[run.first].x - 0.5 * kSliceStep,
          .end = slices[run.last].x + 0.5 * kSliceStep,
          .start_height = mean_height(slices, run.first, run.first + length - 1),
          .end_height = mean_height(slices, run.last + 1 - length, run.last),
          .variance = end_variance(slices, run)};
}

bool contains_blind(const std::vector<Slice>& slices, const Tread& before, const Tread& behind) {
  return std::any_of(slices.begin(), slices.end(), [&](const Slice& slice) {
    return slice.x > before.end && slice.x < behind.start && slice.kind == SliceKind::blind;
  });
}

/// Standard deviation of the step between two treads [m]. A tread that ends with the soles, or with
/// the blind strip before it, is known by them: it shares no error with what is seen, and its own
/// does not average out.
double step_sigma(const std::vector<Slice>& slices, const Tread& before, const Tread& behind) {
  constexpr double kSolesEnd = 0.12;  // and a cell or two, ahead of the stance's middle [m]
  const double variance = before.variance + behind.variance;
  const bool by_soles = before.end < kSolesEnd || contains_blind(slices, before, behind);
  return std::sqrt(by_soles ? variance / kStepShare : variance);
}

/// Joins treads of one level across holes that are no gap and across the blind strip.
std::vector<Tread> joined(const OneStepConfig& config, const std::vector<Slice>& slices,
                          const std::vector<Tread>& treads) {
  std::vector<Tread> result;
  for (const Tread& tread : treads) {
    if (!result.empty()) {
      Tread& before = result.back();
      const bool short_hole =
          tread.start - before.end < config.gap_min || contains_blind(slices, before, tread);
      if (short_hole && std::abs(tread.start_height - before.end_height) < config.step_min) {
        before.end = tread.end;
        before.end_height = tread.end_height;
        before.variance = std::max(before.variance, tread.variance);
        continue;
      }
    }
    result.push_back(tread);
  }
  return result;
}

/// Whether tread `i` lies too low to be support: a pit, or a slot that no foot fits in.
bool is_hole(const OneStepConfig& config, const std::vector<Tread>& treads, std::size_t i,
             double height_before) {
  const Tread& tread = treads[i];
  if (tread.start_height < height_before - config.pit_depth) return true;
  if (i + 1 >= treads.size()) return false;
  const double lower_side = std::min(height_before, treads[i + 1].start_height);
  return tread.end - tread.start < config.foothold_length &&
         tread.end_height < lower_side - config.step_min;
}

void add_edge(core::OneStepTerrain& terrain, const core::TerrainEdge& edge) {
  if (terrain.edge_count < terrain.edges.size()) terrain.edges[terrain.edge_count++] = edge;
}

void add_gap(core::OneStepTerrain& terrain, const core::TerrainGap& gap) {
  if (terrain.gap_count < terrain.gaps.size()) terrain.gaps[terrain.gap_count++] = gap;
}

/// A break as it is reported.
struct Break {
  const Tread& before;
  const Tread& behind;
  double end;    ///< Of support before, in S [m].
  double start;  ///< Of support behind, in S [m].
  double sigma;  ///< Of either place [m].
};

void list_break(const OneStepConfig& config, const Break& found, core::OneStepTerrain& terrain) {
  core::TerrainEdge edge;
  edge.sigma = found.sigma;
  edge.step = found.behind.start_height - found.before.end_height;
  const auto add = [&](double x, EdgeKind kind) {
    edge.x = x;
    edge.kind = kind;
    add_edge(terrain, edge);
  };
  if (found.start - found.end >= config.gap_min) {
    add(found.end, EdgeKind::gap_near);
    add(found.start, EdgeKind::gap_far);
    // A gap that is wider than told costs a fall: both ends are told a standard deviation outwards.
    add_gap(terrain,
            {found.end - edge.sigma, found.start + edge.sigma, std::sqrt(2.0) * edge.sigma});
  } else if (edge.step >= config.step_min) {
    add(found.start, EdgeKind::up);  // the riser's top
  } else if (edge.step <= -config.step_min) {
    add(found.end, EdgeKind::down);
  }
}

/// Length behind `x` that was looked at and found to bear nothing [m].
double bare_length(const std::vector<Slice>& slices, double x) {
  double bare = 0.0;
  for (const Slice& slice : slices) {
    if (slice.x > x && slice.kind != SliceKind::unseen) bare += kSliceStep;
  }
  return bare;
}

}  // namespace

std::vector<Tread> find_treads(const OneStepConfig& config, const std::vector<Slice>& slices) {
  std::vector<Tread> pieces;
  for (const Run& run : level_runs(config, slices)) pieces.push_back(tread_of(slices, run));
  std::erase_if(pieces, [](const Tread& tread) { return tread.end - tread.start < kSplinter; });
  const std::vector<Tread> all = joined(config, slices, pieces);
  std::vector<Tread> kept;
  double height_before = 0.0;  // of S, where the robot stands
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (is_hole(config, all, i, height_before)) continue;
    kept.push_back(all[i]);
    height_before = all[i].end_height;
  }
  return joined(config, slices, kept);
}

std::vector<double> list_features(const OneStepConfig& config, const std::vector<Slice>& slices,
                                  const DividedLine& line, core::OneStepTerrain& terrain) {
  const std::vector<Tread>& treads = line.treads;
  HOPSCOTCH_CHECK(line.breaks.size() == treads.size());
  std::vector<double> step_sigmas;
  for (std::size_t i = 0; i + 1 < treads.size(); ++i) {
    const TreadBreak& here = line.breaks[i];
    list_break(config,
               {.before = treads[i],
                .behind = treads[i + 1],
                .end = here.end ? here.end->x : treads[i].end,
                .start = here.start ? here.start->x : treads[i + 1].start,
                .sigma = config.edge_sigma},
               terrain);
    step_sigmas.resize(terrain.edge_count, step_sigma(slices, treads[i], treads[i + 1]));
  }
  if (treads.empty()) return step_sigmas;
  const std::optional<EdgeLine>& last = line.breaks.back().end;
  if (bare_length(slices, treads.back().end) >= config.gap_min) {
    add_edge(terrain, {.x = last ? last->x : treads.back().end,
                       .sigma = config.edge_sigma,
                       .kind = EdgeKind::gap_near});
  }
  step_sigmas.resize(terrain.edge_count, core::kNaN);
  return step_sigmas;
}

}  // namespace hopscotch::perception
