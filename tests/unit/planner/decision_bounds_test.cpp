#include "planner/decision_bounds.hpp"

#include "planner/warm_start.hpp"
#include "tests/unit/planner/phase_fixture.hpp"

namespace hopscotch::planner {
namespace {

class Bounds : public testing_support::PhaseTest {
 protected:
  DecisionBounds bounds_ = decision_bounds(model_, task_, layout_);
};

TEST_F(Bounds, FixStartAndEnd) {
  const std::array<double, kFlightDof> start = coordinates_from_links(task_.start.pitch);
  const std::array<double, kFlightDof> end = coordinates_from_links(task_.final_posture);
  const int last = layout_.landing(layout_.steps().landing);
  for (int d = 0; d < kStanceDof; ++d) {
    const std::size_t i = static_cast<std::size_t>(d);
    EXPECT_EQ(bounds_.lower(layout_.takeoff(0) + d), start[i]);
    EXPECT_EQ(bounds_.upper(layout_.takeoff(0) + d), start[i]);
    EXPECT_EQ(bounds_.lower(last + d), end[i]);
    EXPECT_EQ(bounds_.upper(last + d), end[i]);
    EXPECT_EQ(bounds_.lower(last + kStanceDof + d), 0.0);
    EXPECT_EQ(bounds_.upper(last + kStanceDof + d), 0.0);
  }
}

TEST_F(Bounds, LandOnAFlatFoot) {
  const int foot = layout_.flight(layout_.steps().flight) + kFootPitch;
  EXPECT_EQ(bounds_.lower(foot), 0.0);
  EXPECT_EQ(bounds_.upper(foot), 0.0);
}

TEST_F(Bounds, AreNeverEmpty) {
  EXPECT_TRUE((bounds_.lower.array() <= bounds_.upper.array()).all());
}

TEST_F(Bounds, EveryVariableHasAPositiveSize) {
  EXPECT_TRUE((decision_sizes(layout_).array() > 0.0).all());
}

}  // namespace
}  // namespace hopscotch::planner
