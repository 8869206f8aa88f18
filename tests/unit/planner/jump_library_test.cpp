#include "planner/jump_library.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <random>
#include <stdexcept>

#include "planner/chain_layout.hpp"
#include "planner/jump_planner.hpp"
#include "planner/library_compiler.hpp"
#include "tests/unit/planner/planner_fixture.hpp"

namespace hopscotch::planner {
namespace {

using testing_support::hector;
using testing_support::request;
using testing_support::shipped_config;
using testing_support::shipped_model;
using testing_support::shipped_posture;
using testing_support::task;

constexpr StepCounts kFewSteps{3, 4, 5};

/// Numbers as a file can hold them.
KnownJump invented(double distance, double height) {
  const ChainLayout layout{DecisionLayout(kFewSteps)};
  KnownJump jump;
  jump.start.pitch = {0.0, 0.5, -0.75, 0.125};
  jump.start.rate = {0.0, 1.0, -1.0, 0.5};
  jump.distance = distance;
  jump.height = height;
  jump.solution.x = Eigen::VectorXd::Constant(layout.variables(), 0.25);
  jump.solution.slot_multipliers = Eigen::VectorXd::Constant(layout.slots(), -0.5);
  jump.solution.equality_multipliers = Eigen::VectorXd::Constant(layout.equalities(), 3.0);
  jump.correction.assign(3 + 4 + 5, StepCorrection{{0.0, 0.125, 0.0, 0.25}, {1.0, 2.0, 3.0, 4.0}});
  return jump;
}

JumpLibrary small_library() {
  JumpLibrary library("hopper", kFewSteps);
  library.add(invented(0.25, 0.0));
  library.add(invented(0.5, -0.125));
  return library;
}

TEST(JumpLibrary, IsTheSameAfterWritingAndReading) {
  const JumpLibrary read = JumpLibrary::from_bytes(small_library().bytes());
  EXPECT_EQ(read.robot(), "hopper");
  EXPECT_TRUE(read.fits(kFewSteps));
  EXPECT_FALSE(read.fits({3, 4, 6}));
  ASSERT_EQ(read.jumps().size(), 2U);
  const KnownJump sent = invented(0.5, -0.125);
  const KnownJump& got = read.jumps()[1];
  EXPECT_EQ(got.start.pitch, sent.start.pitch);
  EXPECT_EQ(got.start.rate, sent.start.rate);
  EXPECT_EQ(got.distance, 0.5);
  EXPECT_EQ(got.height, -0.125);
  EXPECT_EQ(got.solution.x, sent.solution.x);
  EXPECT_EQ(got.solution.slot_multipliers, sent.solution.slot_multipliers);
  EXPECT_EQ(got.solution.equality_multipliers, sent.solution.equality_multipliers);
  ASSERT_EQ(got.correction.size(), sent.correction.size());
  EXPECT_EQ(got.correction[7].turn, sent.correction[7].turn);
  EXPECT_EQ(got.correction[7].acceleration, sent.correction[7].acceleration);
}

TEST(JumpLibrary, MultipliersKeepThreeDigits) {
  JumpLibrary library("hopper", kFewSteps);
  KnownJump jump = invented(0.25, 0.0);
  jump.solution.slot_multipliers.setConstant(-123.456);
  library.add(jump);
  const JumpLibrary read = JumpLibrary::from_bytes(library.bytes());
  EXPECT_NEAR(read.jumps()[0].solution.slot_multipliers(0), -123.456, 0.004 * 123.456);
}

TEST(JumpLibrary, RefusesEveryTruncatedFile) {
  const std::string bytes = small_library().bytes();
  for (std::size_t size = 0; size < bytes.size(); size += 1 + size / 40) {
    EXPECT_THROW((void)JumpLibrary::from_bytes(bytes.substr(0, size)), std::invalid_argument);
  }
  EXPECT_THROW((void)JumpLibrary::from_bytes(bytes + "x"), std::invalid_argument);
}

TEST(JumpLibrary, HostileBytesAreReadOrRefused) {
  const std::string bytes = small_library().bytes();
  std::mt19937 generator(3);
  std::uniform_int_distribution<std::size_t> place(0, bytes.size() - 1);
  std::uniform_int_distribution<int> value(-128, 127);
  int refused = 0;
  for (int i = 0; i < 2000; ++i) {
    std::string broken = bytes;
    const std::size_t limit = i % 2 == 0 ? 60 : bytes.size();  // half of them in the head
    broken[place(generator) % limit] = static_cast<char>(value(generator));
    try {
      const JumpLibrary read = JumpLibrary::from_bytes(broken);
      for (const KnownJump& jump : read.jumps()) ASSERT_TRUE(jump.solution.x.allFinite());
    } catch (const std::invalid_argument&) {
      ++refused;
    }
  }
  EXPECT_GT(refused, 100);
}

TEST(JumpLibrary, FindsTheMostAlikeFirstAndNothingFar) {
  const PlanarModel model = shipped_model();
  const PlanarTask wanted = task(model, 0.42, 0.0);
  JumpLibrary library("hector", shipped_config().steps);
  for (const auto& [distance, height] :
       {std::pair{0.50, 0.0}, std::pair{0.40, 0.0}, std::pair{0.45, 0.0}, std::pair{0.40, 0.20}}) {
    KnownJump jump;
    jump.start = wanted.start;
    jump.distance = distance;
    jump.height = height;
    library.add(jump);
  }
  KnownJump crouched = library.jumps()[1];
  crouched.start.pitch[model::kShank] += 0.3;
  library.add(crouched);
  const std::vector<const KnownJump*> found = library.nearest(wanted, 10);
  ASSERT_EQ(found.size(), 3U);
  EXPECT_EQ(found[0]->distance, 0.40);
  EXPECT_EQ(found[1]->distance, 0.45);
  EXPECT_EQ(found[2]->distance, 0.50);
  EXPECT_EQ(library.nearest(wanted, 1).size(), 1U);
}

TEST(CompileLibrary, HoldsWhatIsPlannedOfTheGrid) {
  LibraryGrid grid;
  grid.distance_from = 0.40;
  grid.distance_to = 0.80;
  grid.distance_step = 0.40;  // nobody leaps 0.80 m
  grid.height_from = grid.height_to = 0.0;
  double last_share = 0.0;
  const JumpLibrary library =
      compile_library(shipped_config(), hector(), shipped_posture(), grid, [&](double share) {
        EXPECT_GT(share, last_share);
        last_share = share;
      });
  EXPECT_LE(last_share, 1.0);
  EXPECT_EQ(library.robot(), "hector");
  ASSERT_EQ(library.jumps().size(), 3U);  // from three start states
  for (const KnownJump& jump : library.jumps()) {
    EXPECT_EQ(jump.distance, 0.40);
    EXPECT_TRUE(jump.solution.x.allFinite());
    EXPECT_GT(jump.solution.slot_multipliers.cwiseAbs().maxCoeff(), 0.0);
  }
}

/// Four targets from each start state, with several local minima.
LibraryGrid uphill_grid() {
  LibraryGrid grid;
  grid.distance_from = 0.30;
  grid.distance_to = 0.33;
  grid.distance_step = 0.03;
  grid.height_from = 0.10;
  grid.height_to = 0.15;
  grid.height_step = grid.other_height_step = 0.05;
  return grid;
}

TEST(CompileLibrary, KeepsTheCheapestOfSeveralLocalMinima) {
  constexpr double kSame = 1e-3;  // of costs, relative
  const auto library = std::make_shared<const JumpLibrary>(
      compile_library(shipped_config(), hector(), shipped_posture(), uphill_grid(), [](double) {}));
  ASSERT_EQ(library->jumps().size(), 12U);
  JumpPlanner planner(shipped_config(), hector(), library);
  int cheaper = 0;
  for (const double distance : {0.30, 0.33}) {
    for (const double height : {0.10, 0.15}) {
      PlanRequest wanted = request(distance, height);
      ASSERT_TRUE(planner.plan(wanted)) << distance << ' ' << height;
      const double from_library = planner.cost();
      wanted.guess = StartGuess::kinematic;
      ASSERT_TRUE(planner.plan(wanted)) << distance << ' ' << height;
      EXPECT_LE(from_library, (1.0 + kSame) * planner.cost()) << distance << ' ' << height;
      if (from_library < (1.0 - kSame) * planner.cost()) ++cheaper;
    }
  }
  EXPECT_GT(cheaper, 0) << "the grid has only one minimum for each target: choose another";
}

}  // namespace
}  // namespace hopscotch::planner
