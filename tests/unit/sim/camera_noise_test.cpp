#include "sim/camera_noise.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

namespace hopscotch::sim {
namespace {

constexpr int kWidth = 640;
constexpr int kHeight = 480;
constexpr core::CameraIntrinsics kCamera{kWidth, kHeight, 385.0, 385.0, 319.5, 239.5};
constexpr DepthRange kRange{};

using Image = std::vector<float>;

std::size_t at(int u, int v) {
  return static_cast<std::size_t>(v * kWidth + u);
}

Image wall(double z) {
  return Image(static_cast<std::size_t>(kWidth * kHeight), static_cast<float>(z));
}

Image measure(const Image& exact, std::uint64_t seed, std::uint64_t frame,
              const DepthNoiseModel& model = {}) {
  DepthNoise noise(model, kCamera, kRange, seed);
  Image measured;
  noise.apply(frame, exact, measured);
  return measured;
}

/// Errors of a wall, without the band that one imager cannot see; lost pixels as 0.
Image wall_errors(double z, std::uint64_t frame) {
  Image errors = measure(wall(z), 3, frame);
  for (float& value : errors) value = value > 0.0F ? value - static_cast<float>(z) : 0.0F;
  return errors;
}

/// Mean product of errors `du`, `dv` pixels apart, over several frames [m^2].
double covariance(double z, int du, int dv) {
  double sum = 0.0;
  int count = 0;
  for (std::uint64_t frame = 0; frame < 10; ++frame) {
    const Image errors = wall_errors(z, frame);
    for (int v = 0; v + dv < kHeight; ++v) {
      for (int u = 100; u + du < kWidth; ++u) {
        sum +=
            static_cast<double>(errors[at(u, v)]) * static_cast<double>(errors[at(u + du, v + dv)]);
        ++count;
      }
    }
  }
  return sum / count;
}

TEST(DepthNoise, SpreadGrowsWithTheSquareOfDepth) {
  for (const double z : {0.5, 1.0, 2.0}) {
    const double sigma = std::sqrt(covariance(z, 0, 0));
    const double expected = 0.001 + 0.0036 * z * z;
    // Ten frames hold some 20 000 independent patches: 0.5 %; rounding to 1 mm adds up to 1 %.
    EXPECT_NEAR(sigma, expected, 0.03 * expected) << "z = " << z;
  }
}

TEST(DepthNoise, ErrorHasNoBias) {
  double sum = 0.0;
  for (std::uint64_t frame = 0; frame < 10; ++frame) {
    const Image errors = wall_errors(1.0, frame);
    for (int v = 0; v < kHeight; ++v) {
      for (int u = 100; u < kWidth; ++u) sum += static_cast<double>(errors[at(u, v)]);
    }
  }
  EXPECT_NEAR(sum / (10.0 * kHeight * (kWidth - 100)), 0.0, 2e-4);
}

TEST(DepthNoise, NeighboursErrAlike) {
  const double variance = covariance(1.0, 0, 0);
  struct Case {
    int pixels;
    double lowest, highest;  // measured on a D435, across and down, with a margin of 0.05
  };
  for (const Case c : {Case{1, 0.90, 1.0}, Case{4, 0.67, 0.90}, Case{8, 0.28, 0.57},
                       Case{14, 0.0, 0.20}, Case{40, -0.05, 0.05}}) {
    const double across = covariance(1.0, c.pixels, 0) / variance;
    const double down = covariance(1.0, 0, c.pixels) / variance;
    EXPECT_TRUE(across > c.lowest && across < c.highest) << c.pixels << ": " << across;
    EXPECT_TRUE(down > c.lowest && down < c.highest) << c.pixels << ": " << down;
  }
}

TEST(DepthNoise, SpreadIsTheSameBetweenTheNodesOfTheField) {
  double on_nodes = 0.0;
  double between = 0.0;
  const int spacing = DepthNoiseModel{}.node_spacing;
  for (std::uint64_t frame = 0; frame < 20; ++frame) {
    const Image errors = wall_errors(1.0, frame);
    for (int v = 0; v + spacing < kHeight; v += spacing) {
      for (int u = 10 * spacing; u + spacing < kWidth; u += spacing) {
        const double node = static_cast<double>(errors[at(u, v)]);
        const double middle = static_cast<double>(errors[at(u + spacing / 2, v + spacing / 2)]);
        on_nodes += node * node;
        between += middle * middle;
      }
    }
  }
  EXPECT_NEAR(between / on_nodes, 1.0, 0.05);  // 34 000 samples each: 1 % standard error
}

TEST(DepthNoise, OutputIsInWholeMillimetres) {
  for (const float z : measure(wall(0.8), 1, 0)) {
    const double steps = static_cast<double>(z) / 0.001;
    ASSERT_NEAR(steps, std::round(steps), 1e-3);
  }
}

TEST(DepthNoise, SameSeedAndFrameGiveTheSameBytesInAnyOrder) {
  const Image exact = wall(1.3);
  DepthNoise noise({}, kCamera, kRange, 5);
  Image first, other, again;
  noise.apply(4, exact, first);
  noise.apply(9, exact, other);
  noise.apply(4, exact, again);
  EXPECT_EQ(first, again);
  EXPECT_EQ(first, measure(exact, 5, 4));
  EXPECT_NE(first, other);
  EXPECT_NE(first, measure(exact, 6, 4));
}

TEST(DepthNoise, FacingWallLosesOnlyTheRandomShare) {
  const Image measured = measure(wall(0.7), 2, 0);
  int lost = 0;
  for (int v = 0; v < kHeight; ++v) {
    for (int u = 100; u < kWidth; ++u) lost += measured[at(u, v)] == 0.0F ? 1 : 0;
  }
  EXPECT_NEAR(lost / static_cast<double>(kHeight * (kWidth - 100)), 0.002, 0.001);
}

TEST(DepthNoise, RightImagerMissesABandAtTheLeft) {
  const Image measured = measure(wall(0.7), 2, 0);
  const int band = static_cast<int>(std::ceil(385.0 * 0.050 / 0.7));
  for (int v = 0; v < kHeight; ++v) {
    for (int u = 0; u < band; ++u) ASSERT_EQ(measured[at(u, v)], 0.0F);
  }
}

TEST(DepthNoise, NoMeasurementStaysNone) {
  for (const float z : measure(wall(0.0), 2, 0)) ASSERT_EQ(z, 0.0F);
}

/// A floor at `height` below a level camera: lower rows are nearer, the horizon is grazing.
Image floor_below(double height) {
  Image image = wall(0.0);
  for (int v = 240; v < kHeight; ++v) {
    const double z = height * 385.0 / (v - 239.5);
    if (z > kRange.farthest) continue;
    for (int u = 0; u < kWidth; ++u) image[at(u, v)] = static_cast<float>(z);
  }
  return image;
}

double lost_share(const Image& exact, const Image& measured, int v) {
  int lost = 0;
  for (int u = 260; u < 380; ++u) {
    if (exact[at(u, v)] > 0.0F && measured[at(u, v)] == 0.0F) ++lost;
  }
  return lost / 120.0;
}

TEST(DepthNoise, GrazingSurfacesAreLost) {
  // In the middle column the cosine of incidence is height / distance along the ray.
  const Image exact = floor_below(0.3);
  const Image measured = measure(exact, 4, 0);
  const auto row_of_cosine = [](double cosine) {
    return static_cast<int>(std::lround(239.5 + 385.0 * std::tan(std::asin(cosine))));
  };
  EXPECT_LT(lost_share(exact, measured, row_of_cosine(0.25)), 0.03);
  EXPECT_NEAR(lost_share(exact, measured, row_of_cosine(0.125)), 0.5, 0.15);

  const Image low = floor_below(0.1);
  EXPECT_GT(lost_share(low, measure(low, 4, 0), row_of_cosine(0.045)), 0.95);
}

/// A box 0.5 m away in front of a wall at 1 m.
Image box_before_wall() {
  Image image = wall(1.0);
  for (int v = 150; v < 350; ++v) {
    for (int u = 250; u < 450; ++u) image[at(u, v)] = 0.5F;
  }
  return image;
}

TEST(DepthNoise, EdgesBleedBetweenTheTwoSurfacesOnly) {
  const Image measured = measure(box_before_wall(), 8, 0);
  int flying = 0;
  int flying_elsewhere = 0;
  for (int v = 0; v < kHeight; ++v) {
    for (int u = 0; u < kWidth; ++u) {
      const float z = measured[at(u, v)];
      if (z == 0.0F) continue;
      EXPECT_GT(z, 0.45F);
      EXPECT_LT(z, 1.05F);
      if (z < 0.55F || z > 0.95F) continue;
      const bool beside_box = u >= 248 && u < 452 && v >= 148 && v < 352;
      ++(beside_box ? flying : flying_elsewhere);
    }
  }
  EXPECT_EQ(flying_elsewhere, 0);
  // 600 edge pixels without the shadowed left side, two deep, 30 % flying, 80 % of them in between.
  EXPECT_NEAR(flying, 288, 80);
}

TEST(DepthNoise, NearObjectCastsAStereoShadowToItsLeft) {
  const Image measured = measure(box_before_wall(), 8, 0);
  // Difference of the disparities of box and wall.
  const int shadow = static_cast<int>(std::floor(385.0 * 0.050 * (1.0 / 0.5 - 1.0 / 1.0)));
  int seen_left = 0;
  int seen_right = 0;
  for (int v = 160; v < 340; ++v) {
    for (int k = 3; k <= shadow; ++k) {
      if (measured[at(250 - k, v)] > 0.0F) ++seen_left;
      if (measured[at(449 + k, v)] > 0.0F) ++seen_right;
    }
  }
  EXPECT_EQ(seen_left, 0);
  EXPECT_GT(seen_right, 180 * (shadow - 2) * 95 / 100);
}

}  // namespace
}  // namespace hopscotch::sim
