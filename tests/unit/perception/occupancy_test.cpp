#include "perception/occupancy.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/unit/perception/synthetic_terrain.hpp"

namespace hopscotch::perception {
namespace {

using Voxel = OccupancyMemory::Voxel;
using test::Course;

const Course kFlat{.blocks = {{-1.0, 5.0, 0.0}}};
const Course kBox{.blocks = {{-1.0, 5.0, 0.0}, {0.70, 0.85, 0.12, 0.2}}};
const Course kGap{.blocks = {{-1.0, 0.45, 0.0}, {0.60, 5.0, 0.0}}};
constexpr double kBeamBottom = 0.35;  // [m]

core::RobotState standing() {
  return test::standing_at(kFlat, 0.0, 0.0, 0.0);
}

/// The course as the standing robot sees it, its own body and doubtful pixels left out.
class View {
 public:
  enum class Beam : std::uint8_t { none, hangs };

  View(const Course& course, std::uint32_t seed, Beam beam = Beam::none)
      : mapper_(test::perception_config(), test::hector()) {
    core::DepthFrame frame = test::render(course, standing(), 320, 240);
    if (beam == Beam::hangs) hang_beam(frame);
    test::add_noise(frame, seed);
    EXPECT_EQ(mapper_.integrate(frame, standing()), MapStatus::fused);
  }

  [[nodiscard]] const PlacedDepth& image() const { return *mapper_.image(); }

 private:
  /// Across the way, 0.6 to 0.7 m ahead.
  static void hang_beam(core::DepthFrame& frame) {
    Eigen::Isometry3d X_WC = Eigen::Isometry3d::Identity();
    X_WC.linear() = standing().R_WB;
    X_WC.translation() = standing().p_WB;
    X_WC = X_WC * frame.X_BC;
    const core::CameraIntrinsics& lens = frame.intrinsics;
    for (int v = 0; v < lens.height; ++v) {
      for (int u = 0; u < lens.width; ++u) {
        const Eigen::Vector3d ray =
            X_WC.linear() * Eigen::Vector3d((u - lens.cx) / lens.fx, (v - lens.cy) / lens.fy, 1.0);
        const double depth =
            test::hit_box({0.6, -1.0, kBeamBottom}, {0.7, 1.0, 0.8}, X_WC.translation(), ray);
        float& z = frame.depth[static_cast<std::size_t>(v * lens.width + u)];
        if (depth < 3.0 && (z == 0.0F || depth < static_cast<double>(z))) {
          z = static_cast<float>(depth);
        }
      }
    }
  }

  TerrainMapper mapper_;
};

OccupancyMemory memory() {
  return OccupancyMemory(test::perception_config().occupancy);
}

/// Takes the views in, a period apart.
void look(OccupancyMemory& volume, const View& view, int first, int count) {
  for (int k = first; k < first + count; ++k) {
    ASSERT_TRUE(volume.insert(view.image(), core::Stamp::from_seconds(0.1 * k)));
  }
}

/// Of what hangs within the body's width and over the flight, the lowest bottom [m].
double lowest_over_the_way(const OccupancyMemory& volume) {
  double lowest = 9.0;
  for (const Eigen::Vector3f& bottom : volume.hanging()) {
    const bool on_the_way = bottom.x() > 0.2F && bottom.x() < 1.2F && std::abs(bottom.y()) < 0.15F;
    if (on_the_way && bottom.z() > 0.15F) lowest = std::min(lowest, double{bottom.z()});
  }
  return lowest;
}

TEST(Occupancy, BoxIsRememberedAndClearedByTwoFramesOnceItIsGone) {
  OccupancyMemory volume = memory();
  const Eigen::Vector3f in_box(0.705F, 0.0F, 0.09F);
  look(volume, View(kBox, 7U), 0, 3);
  EXPECT_EQ(volume.at(in_box), Voxel::occupied);
  look(volume, View(kFlat, 9U), 3, 2);
  EXPECT_NE(volume.at(in_box), Voxel::occupied);
}

TEST(Occupancy, FramesWithinAPeriodAreLeftOut) {
  OccupancyMemory volume = memory();
  const View view(kFlat, 3U);
  EXPECT_TRUE(volume.insert(view.image(), core::Stamp::from_seconds(1.0)));
  EXPECT_FALSE(volume.insert(view.image(), core::Stamp::from_seconds(1.033)));
  EXPECT_FALSE(volume.insert(view.image(), core::Stamp::from_seconds(0.9)));
}

TEST(Occupancy, BeamHangsAndNothingElseDoes) {
  for (const Course& course : {kFlat, kBox, kGap}) {
    OccupancyMemory volume = memory();
    look(volume, View(course, 30U), 0, 3);
    EXPECT_GT(lowest_over_the_way(volume), 1.0);
  }
  OccupancyMemory volume = memory();
  look(volume, View(kFlat, 31U, View::Beam::hangs), 0, 3);
  EXPECT_NEAR(lowest_over_the_way(volume), kBeamBottom, 0.035);
}

// Only where the camera now sees something behind it: pixels beyond its range clear nothing.
TEST(Occupancy, BeamThatIsTakenAwayHangsNoLongerWhereTheGroundBehindItIsSeen) {
  constexpr float kSeenThrough = 0.40F;  // [m]
  OccupancyMemory volume = memory();
  look(volume, View(kFlat, 31U, View::Beam::hangs), 0, 3);
  look(volume, View(kFlat, 32U), 3, 2);
  EXPECT_GT(lowest_over_the_way(volume), double{kSeenThrough});
}

TEST(Occupancy, WhatIsFarBehindIsForgotten) {
  OccupancyConfig config = test::perception_config().occupancy;
  config.nodes_max = 1000;
  OccupancyMemory volume(config);
  look(volume, View(kBox, 7U), 0, 3);
  const View here(kFlat, 8U);
  PlacedDepth far_away = here.image();
  far_away.X_WC.translation().x() += 10.0;
  EXPECT_TRUE(volume.insert(far_away, core::Stamp::from_seconds(1.0)));
  EXPECT_EQ(volume.at({0.705F, 0.0F, 0.09F}), Voxel::unknown);
}

}  // namespace
}  // namespace hopscotch::perception
