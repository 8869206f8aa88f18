#include "tests/accuracy/accuracy.hpp"

#include <gtest/gtest.h>

#include <cmath>

/// A few hundred of the worlds that `perception_accuracy` measures by the thousand. The bounds are
/// those that perception is built for; rates that few worlds cannot show are bounded by what so few
/// may hold at those rates.
namespace hopscotch::accuracy {
namespace {

constexpr std::uint64_t kFirst = 100'001;

TEST(Accuracy, OfHeightsEdgesStepsAndGaps) {
  const Figures figures = measure(kFirst, 120, {});
  SCOPED_TRACE(figures.text());
  EXPECT_LE(figures.near_height.rms(), 0.004);
  EXPECT_LE(figures.far_height.rms(), 0.007);
  EXPECT_LE(figures.edge.rms(), 0.008);
  EXPECT_LE(figures.edge.quantile(0.95), 0.015);
  EXPECT_LE(std::abs(figures.step.bias()), 0.002);
  EXPECT_LE(figures.step.quantile(0.95), 0.006);
  EXPECT_LE(figures.gap_width.quantile(0.95), 0.020);
  EXPECT_LE(figures.gap_width.share_below(-0.005), 0.02) << "one in a hundred gaps may be";
  // Few worlds, and what all frames of a world share is drawn once for each.
  EXPECT_GE(figures.near_height.nees(), 0.6);
  EXPECT_LE(figures.near_height.nees(), 1.6);
  EXPECT_GE(figures.edge.nees(), 0.6);
  EXPECT_LE(figures.edge.nees(), 1.4);
  EXPECT_GE(figures.step.nees(), 0.5);
  EXPECT_LE(figures.step.nees(), 1.6);
  EXPECT_GT(figures.edge.values.size(), 200U) << "or else nothing was looked at";
  EXPECT_GT(figures.near_cells.value(), 0.98);
  EXPECT_GT(figures.far_cells.value(), 0.95);
  EXPECT_EQ(figures.false_safe, 0);
  EXPECT_LE(figures.false_reject, figures.roomy / 10);
}

/// No target may lie over an edge, whatever is wrong: at the allowed rate of 5 in 1000 so few
/// worlds hold none.
void expect_safe_targets(const Faults& faults) {
  const Figures figures = measure(kFirst, 25, faults);
  SCOPED_TRACE(figures.text());
  EXPECT_EQ(figures.false_safe, 0);
  EXPECT_GT(figures.accepted, 20) << "or else nothing was chosen";
}

TEST(Accuracy, NoTargetIsUnsafeWithoutAFifthOfThePixels) {
  expect_safe_targets({.dropout = 0.2});
}

TEST(Accuracy, NoTargetIsUnsafeWithPosesOfThirtyMillisecondsAgo) {
  expect_safe_targets({.time_error = 0.03});
}

TEST(Accuracy, NoTargetIsUnsafeWithACameraBentByADegree) {
  expect_safe_targets({.pitch_error = 0.01745});
}

TEST(Accuracy, NoTargetIsUnsafeWithALegInView) {
  expect_safe_targets({.leg_error = 0.1});
}

}  // namespace
}  // namespace hopscotch::accuracy
