#include "perception/line_survey.hpp"

#include <algorithm>
#include <cmath>

#include "perception/edge_lines.hpp"
#include "perception/step_features.hpp"
#include "perception/track_slices.hpp"

namespace hopscotch::perception {

namespace {

/// Height over x as a straight line through the observed slices of a tread.
SurveyedTread fit_line(const Tread& tread, const std::vector<Slice>& slices) {
  SurveyedTread result{.start = tread.start, .end = tread.end};
  const double middle = 0.5 * (tread.start + tread.end);
  double sum_z = 0.0;
  double sum_x = 0.0;
  double sum_xx = 0.0;
  double sum_xz = 0.0;
  std::vector<const Slice*> on_it;
  for (const Slice& slice : slices) {
    if (slice.x < tread.start || slice.x > tread.end || slice.kind != SliceKind::level) continue;
    on_it.push_back(&slice);
    const double x = slice.x - middle;
    sum_x += x;
    sum_z += slice.mean;
    sum_xx += x * x;
    sum_xz += x * slice.mean;
  }
  result.slices = static_cast<int>(on_it.size());
  const double n = static_cast<double>(on_it.size());
  const double spread = n * sum_xx - sum_x * sum_x;
  if (n < 2 || !(spread > 0.0)) return result;
  const double slope = (n * sum_xz - sum_x * sum_z) / spread;
  result.height = (sum_z - slope * sum_x) / n;
  result.slope = std::atan(slope);
  std::vector<double> residuals;
  for (const Slice* slice : on_it) {
    residuals.push_back(slice->mean - result.height - slope * (slice->x - middle));
  }
  std::sort(residuals.begin(), residuals.end());
  const auto percentile = [&](double share) {
    return residuals[static_cast<std::size_t>(share * (n - 1.0) + 0.5)];
  };
  result.roughness = percentile(0.95) - percentile(0.05);
  return result;
}

}  // namespace

const SurveyedTread* LineSurvey::ground() const {
  const auto at_feet = std::find_if(treads.begin(), treads.end(),
                                    [](const SurveyedTread& tread) { return tread.end > 0.0; });
  return at_feet == treads.end() ? nullptr : &*at_feet;
}

LineSurvey survey_line(const OneStepConfig& config, const core::TerrainMap& map,
                       const StancePose& stance, double to_x) {
  SliceRange range;
  range.count = static_cast<int>(std::ceil((to_x - range.start) / kSliceStep));
  const std::vector<Slice> slices = cut_slices(config, map, stance, range);
  DividedLine line{.treads = find_treads(config, slices), .breaks = {}};
  line.breaks = find_breaks(map, stance, line.treads);
  LineSurvey survey;
  survey.features.stamp = map.stamp;
  survey.features.p_WS = stance.p_WS;
  survey.features.heading = stance.heading;
  survey.step_sigmas = list_features(config, slices, line, survey.features);
  for (const Tread& tread : line.treads) survey.treads.push_back(fit_line(tread, slices));
  return survey;
}

}  // namespace hopscotch::perception
