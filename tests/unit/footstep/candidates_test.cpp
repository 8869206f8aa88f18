#include "footstep/candidates.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "footstep/reachability.hpp"
#include "tests/unit/footstep/known_course.hpp"

namespace hopscotch::footstep {
namespace {

using test::Course;
using test::KnownCourse;

constexpr double kNoGoal = std::numeric_limits<double>::infinity();

bool has_place(const std::vector<Foothold>& scored, double x, double tolerance) {
  return std::any_of(scored.begin(), scored.end(), [&](const Foothold& foothold) {
    return std::abs(foothold.placement.x - x) <= tolerance;
  });
}

TEST(Candidates, RunAlongTheLineThroughTheNominalDistanceInOrder) {
  const FootstepConfig config = test::footstep_config();
  const KnownCourse known(Course{.blocks = {{-1.0, 3.0, 0.0}}});
  const std::vector<Foothold> scored =
      score_candidates(config, known.stance(), known.terrain.profile, kNoGoal);
  EXPECT_TRUE(has_place(scored, config.preference.nominal_distance, 1e-12));
  EXPECT_GE(scored.front().placement.x, shortest_reach(config.reach));
  EXPECT_GT(scored.back().placement.x, 1.3);
  for (std::size_t i = 1; i < scored.size(); ++i) {
    EXPECT_LT(scored[i - 1].placement.x, scored[i].placement.x);
  }
}

TEST(Candidates, IncludeTheCentreOfAShortStone) {
  const FootstepConfig config = test::footstep_config();
  const KnownCourse known(Course{.blocks = {{-1.0, 0.2, 0.0}, {0.338, 0.593, 0.0}}});
  const std::vector<Foothold> scored =
      score_candidates(config, known.stance(), known.terrain.profile, kNoGoal);
  EXPECT_TRUE(has_place(scored, 0.4655, 0.008));
}

TEST(Candidates, IncludeThePlaceWithToesNearTheEdge) {
  const FootstepConfig config = test::footstep_config();
  const KnownCourse known(Course{.blocks = {{-1.0, 0.6, 0.0}, {0.6, 3.0, -0.25}}});
  const std::vector<Foothold> scored =
      score_candidates(config, known.stance(), known.terrain.profile, kNoGoal);
  const auto nearest = [&] {
    double margin = kMarginSearch;
    for (const Foothold& foothold : scored) {
      if (foothold.why == core::Reason::none) margin = std::min(margin, foothold.toe_margin);
    }
    return margin;
  };
  EXPECT_LT(nearest(), config.foothold.margin_min + 0.0101);
}

TEST(Candidates, IncludeTheGoal) {
  const KnownCourse known(Course{.blocks = {{-1.0, 3.0, 0.0}}});
  const std::vector<Foothold> scored =
      score_candidates(test::footstep_config(), known.stance(), known.terrain.profile, 0.3123);
  EXPECT_TRUE(has_place(scored, 0.3123, 1e-12));
}

TEST(Candidates, NoneWhereNothingIsSeen) {
  const KnownCourse known(Course{.blocks = {{-1.0, 3.0, 0.0}}});
  const core::TerrainProfile unseen;  // states start as never seen
  EXPECT_TRUE(score_candidates(test::footstep_config(), known.stance(), unseen, kNoGoal).empty());
}

}  // namespace
}  // namespace hopscotch::footstep
