#include "perception/terrain_mapper.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <random>

#include "perception/body_mask.hpp"
#include "tests/unit/perception/flat_map.hpp"

namespace hopscotch::perception {
namespace {

using core::CellState;
using test::Course;

const Course kFlat{.blocks = {{-1.0, 5.0, 0.0}}};
const Course kStones{
    .blocks = {{-1.0, 0.125, 0.0}, {0.325, 0.575, 0.0}, {0.775, 1.025, 0.0}, {1.225, 3.0, 0.0}}};

bool same_cell(const core::TerrainCell& a, const core::TerrainCell& b) {
  return a.height == b.height && a.variance == b.variance && a.upper == b.upper &&
         a.state == b.state;
}

bool same_cells(const core::TerrainMap& a, const core::TerrainMap& b) {
  return a.origin_x == b.origin_x && a.origin_y == b.origin_y &&
         std::equal(a.cells.begin(), a.cells.end(), b.cells.begin(), b.cells.end(), same_cell);
}

class TerrainMapperTest : public ::testing::Test {
 protected:
  template <typename Visit>
  void for_each_cell(Visit visit) const {
    const core::TerrainMap& map = mapper_.map();
    for (int iy = 0; iy < map.size_y; ++iy) {
      for (int ix = 0; ix < map.size_x; ++ix) {
        visit(map.origin_x + (ix + 0.5) * map.resolution,
              map.origin_y + (iy + 0.5) * map.resolution, map.at(ix, iy));
      }
    }
  }

  TerrainMapper mapper_{test::perception_config(), test::hector()};
};

TEST_F(TerrainMapperTest, HeightsOfLevelGroundAreRightToAFewMillimetres) {
  test::look(kFlat, test::standing_at(kFlat, 0.0, 0.0, 0.0), 8, 11, mapper_);
  double near_sum = 0.0;
  double far_sum = 0.0;
  int near_count = 0;
  int far_count = 0;
  for_each_cell([&](double x, double y, const core::TerrainCell& cell) {
    if (cell.state != CellState::observed || std::abs(y) > 0.4) return;
    const double error = static_cast<double>(cell.height);
    if (x < 0.8) {
      near_sum += error * error;
      ++near_count;
    } else if (x < 1.5) {
      far_sum += error * error;
      ++far_count;
    }
  });
  ASSERT_GT(near_count, 1500);
  ASSERT_GT(far_count, 2000);
  EXPECT_LT(std::sqrt(near_sum / near_count), 0.004);
  EXPECT_LT(std::sqrt(far_sum / far_count), 0.007);
}

TEST_F(TerrainMapperTest, ClaimedVarianceCoversTheError) {
  test::look(kFlat, test::standing_at(kFlat, 0.0, 0.0, 0.0), 8, 12, mapper_);
  double normalised = 0.0;
  int count = 0;
  for_each_cell([&](double x, double, const core::TerrainCell& cell) {
    if (cell.state != CellState::observed || x > 1.5) return;
    normalised += static_cast<double>(cell.height * cell.height / cell.variance);
    ++count;
  });
  EXPECT_LT(normalised / count, 1.3) << "mean of squared errors over claimed variances";
}

TEST_F(TerrainMapperTest, NoSupportIsInventedOverGaps) {
  const core::RobotState state = test::standing_at(kStones, 0.0, 0.0, 0.0);
  mapper_.anchor_support(state);
  test::look(kStones, state, 10, 13, mapper_);
  for_each_cell([&](double x, double y, const core::TerrainCell& cell) {
    if (cell.state != CellState::observed || std::abs(y) > 0.55 || x > 1.1) return;
    const double step = 0.0075 + 0.005;  // half a cell, and what noise adds
    const bool near_tread =
        test::top_at(kStones, x - step, y) == 0.0 || test::top_at(kStones, x + step, y) == 0.0;
    if (near_tread) return;
    EXPECT_LT(cell.height, -0.03) << "at " << x << ", " << y;
  });
}

TEST_F(TerrainMapperTest, HiddenGroundIsBoundedNeverObserved) {
  const Course drop{.blocks = {{-1.0, 0.6, 0.0}, {0.6, 3.0, -0.25}}};
  test::look(drop, test::standing_at(drop, 0.0, 0.0, 0.0), 8, 14, mapper_);
  int occluded = 0;
  for_each_cell([&](double x, double y, const core::TerrainCell& cell) {
    if (x < 0.63 || x > 0.72 || std::abs(y) > 0.2) return;
    EXPECT_NE(cell.state, CellState::observed) << "at " << x << ", " << y;
    if (cell.state != CellState::occluded) return;
    ++occluded;
    EXPECT_GE(cell.upper, -0.25F) << "a bound must hold";
    EXPECT_LT(cell.upper, 0.01F) << "and be of use";
  });
  EXPECT_GT(occluded, 100);
}

TEST_F(TerrainMapperTest, SolesAnchorTheGroundThatTheCameraCannotSee) {
  const core::RobotState state = test::standing_at(kFlat, 0.0, 0.02, 0.0);
  EXPECT_EQ(mapper_.anchor_support(state), MapStatus::fused);
  int anchored = 0;
  for_each_cell([&](double x, double y, const core::TerrainCell& cell) {
    const bool under = std::abs(x) <= 0.075 && std::abs(std::abs(y) - 0.098) <= 0.01;
    if (under) {
      EXPECT_EQ(cell.state, CellState::observed) << x << ", " << y;
    }
    if (cell.state != CellState::observed) return;
    ++anchored;
    EXPECT_NEAR(cell.height, 0.02, 1e-5);
    EXPECT_LT(std::abs(x), 0.08) << "nothing ahead of the toes is support by contact";
  });
  EXPECT_GT(anchored, 80);
}

TEST_F(TerrainMapperTest, MapRemembersWhatWasAheadWhenTheRobotStandsOnIt) {
  test::look(kFlat, test::standing_at(kFlat, 0.0, 0.0, 0.0), 6, 15, mapper_);
  test::look(kFlat, test::standing_at(kFlat, 0.8, 0.0, 1.0), 2, 16, mapper_);
  int seen_below = 0;
  for_each_cell([&](double x, double y, const core::TerrainCell& cell) {
    const bool below = x > 0.72 && x < 0.88 && std::abs(y) < 0.12;
    if (below && cell.state == CellState::observed) ++seen_below;
  });
  EXPECT_GT(seen_below, 150);  // of 160
}

TEST_F(TerrainMapperTest, MovedBoxIsReplacedWithinTwoFrames) {
  const Course with_box{.blocks = {{-1.0, 5.0, 0.0}, {0.6, 0.8, 0.15, 0.2}}};
  test::look(with_box, test::standing_at(with_box, 0.0, 0.0, 0.0), 6, 17, mapper_);
  const auto highest = [&] {
    float top = -1.0F;
    for_each_cell([&](double x, double y, const core::TerrainCell& cell) {
      const bool inside = x > 0.62 && x < 0.78 && std::abs(y) < 0.18;
      if (inside && cell.state == CellState::observed) top = std::max(top, cell.height);
    });
    return top;
  };
  EXPECT_GT(highest(), 0.14F);
  test::look(kFlat, test::standing_at(kFlat, 0.0, 0.0, 1.0), 2, 18, mapper_);
  EXPECT_LT(highest(), 0.02F);
}

TEST_F(TerrainMapperTest, WhatADriftedStateSawIsReplacedWithinTwoFrames) {
  core::RobotState drifted = test::standing_at(kFlat, 0.0, 0.0, 0.0);
  drifted.p_WB.z() += 0.030;
  for (int i = 0; i < 6; ++i) {
    core::DepthFrame frame = test::render(kFlat, test::standing_at(kFlat, 0.0, 0.0, 0.0));
    frame.stamp = core::Stamp::from_seconds(0.03 * (i + 1));
    ASSERT_EQ(mapper_.integrate(frame, drifted), MapStatus::fused);
  }
  test::look(kFlat, test::standing_at(kFlat, 0.0, 0.0, 1.0), 2, 23, mapper_);
  int near = 0;
  for_each_cell([&](double x, double y, const core::TerrainCell& cell) {
    if (cell.state != CellState::observed || x > 1.0 || std::abs(y) > 0.2) return;
    ++near;
    EXPECT_NEAR(cell.height, 0.0, 0.015) << "at " << x << ", " << y;
  });
  EXPECT_GT(near, 1000);
}

TEST_F(TerrainMapperTest, FortyPercentDropoutInventsNothing) {
  const core::RobotState state = test::standing_at(kStones, 0.0, 0.0, 0.0);
  std::mt19937 random(24);
  std::bernoulli_distribution lost(0.4);
  for (int i = 0; i < 8; ++i) {
    core::DepthFrame frame = test::render(kStones, state);
    for (float& z : frame.depth) z = lost(random) ? 0.0F : z;
    frame.stamp = core::Stamp::from_seconds(0.03 * (i + 1));
    ASSERT_EQ(mapper_.integrate(frame, state), MapStatus::fused);
  }
  int seen = 0;
  for_each_cell([&](double x, double y, const core::TerrainCell& cell) {
    if (cell.state != CellState::observed || std::abs(y) > 0.5 || x > 1.0) return;
    ++seen;
    const double reach = 0.010;  // an edge cell and half of the next
    const bool real = std::abs(test::top_at(kStones, x - reach, y) - cell.height) < 0.02 ||
                      std::abs(test::top_at(kStones, x, y) - cell.height) < 0.02 ||
                      std::abs(test::top_at(kStones, x + reach, y) - cell.height) < 0.02;
    EXPECT_TRUE(real || cell.height < -0.03F) << "at " << x << ", " << y;
  });
  EXPECT_GT(seen, 1000);
}

TEST_F(TerrainMapperTest, OwnLegsDoNotBecomeGround) {
  // A leg lifted high ahead: without the mask, its pixels would stand as a post on the ground.
  core::RobotState state = test::standing_at(kFlat, 0.0, 0.0, 0.0);
  state.q(core::joint_index(core::Leg::left, core::Joint::hip_pitch)) = -1.2;
  state.q(core::joint_index(core::Leg::left, core::Joint::knee)) = -0.1;
  core::DepthFrame frame = test::render(kFlat, state);
  const BodyCapsules body = body_in_camera(test::hector(), state.q, frame.X_BC);
  int painted = 0;
  for (int v = 0; v < frame.intrinsics.height; ++v) {
    for (int u = 0; u < frame.intrinsics.width; ++u) {
      const Eigen::Vector3d ray((u - frame.intrinsics.cx) / frame.intrinsics.fx,
                                (v - frame.intrinsics.cy) / frame.intrinsics.fy, 1.0);
      for (const Capsule& capsule : body) {
        for (int k = 0; k <= 20; ++k) {  // beads along the capsule
          const Eigen::Vector3d bead = capsule.start + 0.05 * k * (capsule.end - capsule.start);
          const double along = ray.dot(bead) / ray.squaredNorm();
          if (along <= 0.0 || (along * ray - bead).norm() > capsule.radius) continue;
          frame.depth[static_cast<std::size_t>(v * frame.intrinsics.width + u)] =
              static_cast<float>(along);
          ++painted;
        }
      }
    }
  }
  ASSERT_GT(painted, 1000) << "the leg must be in view";
  for (int i = 1; i < 6; ++i) {
    frame.stamp = core::Stamp::from_seconds(0.03 * i);
    ASSERT_EQ(mapper_.integrate(frame, state), MapStatus::fused);
  }
  for_each_cell([&](double x, double y, const core::TerrainCell& cell) {
    if (cell.state != CellState::observed || std::abs(y) > 0.55) return;
    ASSERT_NEAR(cell.height, 0.0, 0.01) << "at " << x << ", " << y;
  });
}

TEST_F(TerrainMapperTest, FastTrunkPausesFusion) {
  core::RobotState state = test::standing_at(kFlat, 0.0, 0.0, 0.1);
  const core::DepthFrame frame = test::render(kFlat, state);
  state.w_WB = {0.0, 3.0, 0.0};
  EXPECT_EQ(mapper_.integrate(frame, state), MapStatus::moving);
  state.w_WB.setZero();
  state.v_WB = {2.5, 0.0, 0.0};
  EXPECT_EQ(mapper_.integrate(frame, state), MapStatus::moving);
  state.v_WB.setConstant(core::kNaN);
  EXPECT_EQ(mapper_.integrate(frame, state), MapStatus::moving);
  EXPECT_EQ(mapper_.map().frames, 0);
  state.v_WB.setZero();
  EXPECT_EQ(mapper_.integrate(frame, state), MapStatus::fused);
  EXPECT_EQ(mapper_.map().frames, 1);
}

TEST_F(TerrainMapperTest, BadInputIsNamedAndChangesNothing) {
  const core::RobotState state = test::standing_at(kFlat, 0.0, 0.0, 0.1);
  const core::DepthFrame good = test::render(kFlat, state, 160, 120);
  core::DepthFrame frame = good;
  frame.depth.assign(frame.depth.size(), 0.0F);
  EXPECT_EQ(mapper_.integrate(frame, state), MapStatus::blind);
  frame.depth.assign(frame.depth.size(), std::numeric_limits<float>::quiet_NaN());
  EXPECT_EQ(mapper_.integrate(frame, state), MapStatus::blind);
  frame = good;
  frame.depth.pop_back();
  EXPECT_EQ(mapper_.integrate(frame, state), MapStatus::bad_frame);
  frame = good;
  frame.intrinsics.fx = 0.0;
  EXPECT_EQ(mapper_.integrate(frame, state), MapStatus::bad_frame);
  frame = good;
  frame.X_BC.linear()(2, 2) = -4e14;
  EXPECT_EQ(mapper_.integrate(frame, state), MapStatus::bad_frame) << "no rotation";
  core::RobotState lost = state;
  lost.R_WB *= 2.0;
  EXPECT_EQ(mapper_.integrate(good, lost), MapStatus::bad_state) << "no rotation";
  lost = state;
  lost.p_WB.x() = core::kNaN;
  EXPECT_EQ(mapper_.integrate(good, lost), MapStatus::bad_state);
  EXPECT_EQ(mapper_.anchor_support(lost), MapStatus::bad_state);
  EXPECT_EQ(mapper_.map().frames, 0);
  EXPECT_EQ(mapper_.integrate(good, state), MapStatus::fused);
  EXPECT_EQ(mapper_.integrate(good, state), MapStatus::stale);
}

TEST_F(TerrainMapperTest, IntrinsicsOfAnotherImageSizeAreRefused) {
  const core::RobotState state = test::standing_at(kFlat, 0.0, 0.0, 0.1);
  const core::DepthFrame good = test::render(kFlat, state, 160, 120);
  for (const double times : {0.25, 2.0, 4.0}) {
    core::DepthFrame frame = good;
    core::CameraIntrinsics& lens = frame.intrinsics;
    for (double* const number : {&lens.fx, &lens.fy, &lens.cx, &lens.cy}) *number *= times;
    EXPECT_EQ(mapper_.integrate(frame, state), MapStatus::bad_frame) << times;
  }
  core::DepthFrame frame = good;
  frame.intrinsics.fx *= 10.0;
  EXPECT_EQ(mapper_.integrate(frame, state), MapStatus::bad_frame) << "a view of 8 degrees";
  EXPECT_EQ(mapper_.map().frames, 0);
  EXPECT_EQ(mapper_.integrate(good, state), MapStatus::fused);
}

TEST_F(TerrainMapperTest, MillimetresForMetresAreNoReadings) {
  const core::RobotState state = test::standing_at(kFlat, 0.0, 0.0, 0.1);
  for (const float unit : {1000.0F, 0.001F}) {
    core::DepthFrame frame = test::render(kFlat, state, 160, 120);
    for (float& z : frame.depth) z *= unit;
    EXPECT_EQ(mapper_.integrate(frame, state), MapStatus::blind) << unit;
  }
  EXPECT_EQ(mapper_.map().frames, 0);
}

TEST_F(TerrainMapperTest, TimeThatGoesBackwardsAddsNothing) {
  const core::RobotState state = test::standing_at(kFlat, 0.0, 0.0, 0.2);
  core::DepthFrame frame = test::render(kFlat, state, 160, 120);
  frame.stamp = core::Stamp::from_seconds(0.2);
  ASSERT_EQ(mapper_.integrate(frame, state), MapStatus::fused);
  const core::TerrainMap before = mapper_.map();
  frame.stamp = core::Stamp::from_seconds(0.1);
  for (float& z : frame.depth) z *= 0.5F;
  EXPECT_EQ(mapper_.integrate(frame, state), MapStatus::stale);
  EXPECT_TRUE(same_cells(before, mapper_.map()));
}

TEST_F(TerrainMapperTest, SameFramesGiveTheSameMapBitByBit) {
  TerrainMapper other(test::perception_config(), test::hector());
  for (TerrainMapper* mapper : {&mapper_, &other}) {
    test::look(kStones, test::standing_at(kStones, 0.0, 0.0, 0.0), 3, 21, *mapper);
    test::look(kStones, test::standing_at(kStones, 0.45, 0.0, 1.0), 3, 22, *mapper);
  }
  EXPECT_TRUE(same_cells(mapper_.map(), other.map()));
}

TEST_F(TerrainMapperTest, SurvivesAnyDepthValues) {
  constexpr std::uint32_t kSeed = 20240607;
  SCOPED_TRACE(testing::Message() << "seed " << kSeed);
  std::mt19937 random(kSeed);
  for (int i = 0; i < 60; ++i) {
    core::RobotState state = test::standing_at(kFlat, 0.0, 0.0, 0.1 * (i + 1));
    state.p_WB = Eigen::Vector3d(std::uniform_real_distribution<double>(-50, 50)(random), 0.0,
                                 std::uniform_real_distribution<double>(-2, 2)(random));
    state.R_WB = (Eigen::AngleAxisd(std::uniform_real_distribution<double>(-3, 3)(random),
                                    Eigen::Vector3d(1, 1, i % 3).normalized()))
                     .toRotationMatrix();
    core::DepthFrame frame = test::empty_frame(64, 48, 0.1 * (i + 1));
    const float wall = std::uniform_real_distribution<float>(0.3F, 2.1F)(random);
    for (float& z : frame.depth) {  // a surface with any bit pattern in between
      const std::uint32_t bits = static_cast<std::uint32_t>(random());
      std::memcpy(&z, &bits, sizeof z);
      if (random() % 20 != 0) z = wall;
    }
    mapper_.integrate(frame, state);
    for (const core::TerrainCell& cell : mapper_.map().cells) {
      ASSERT_TRUE(std::isfinite(cell.height));
      ASSERT_TRUE(std::isfinite(cell.variance));
      ASSERT_FALSE(std::isnan(cell.upper));
    }
  }
  EXPECT_GT(mapper_.map().frames, 30);
}

}  // namespace
}  // namespace hopscotch::perception
