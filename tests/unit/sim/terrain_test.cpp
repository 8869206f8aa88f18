#include "sim/terrain.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "sim/random.hpp"

namespace hopscotch::sim {
namespace {

constexpr double kExact = 1e-9;  // rounding of a handful of operations

Slab slab_of(double x0, double x1, double top) {
  Slab slab;
  slab.centre = {0.5 * (x0 + x1), 0.0};
  slab.half_size = {0.5 * (x1 - x0), 0.6};
  slab.top = top;
  return slab;
}

TEST(Slab, TopIsGivenAtTheNearEdgeAndRisesAlongX) {
  Slab slab = slab_of(1.0, 2.0, 0.1);
  slab.slope = 0.2;
  EXPECT_NEAR(slab.height({1.0, 0.3}), 0.1, kExact);
  EXPECT_NEAR(slab.height({2.0, -0.3}), 0.1 + std::tan(0.2), kExact);
  EXPECT_NEAR(slab.lowest(), 0.1, kExact);
  EXPECT_NEAR(slab.highest(), 0.1 + std::tan(0.2), kExact);
}

TEST(Slab, YawTurnsOutlineAndSlopeAboutTheCentre) {
  Slab slab = slab_of(1.0, 2.0, 0.0);
  slab.slope = 0.1;
  slab.yaw = M_PI / 2.0;
  EXPECT_TRUE(slab.contains({1.5 + 0.59, 0.0}));
  EXPECT_FALSE(slab.contains({1.5, 0.51}));
  EXPECT_NEAR(slab.height({1.5, 0.5}) - slab.height({1.5, -0.5}), std::tan(0.1), kExact);
  EXPECT_NEAR(slab.height({1.2, 0.0}), slab.height({1.8, 0.0}), kExact);
}

TEST(Slab, CornersLieOnTheTopAndOnTheOutline) {
  Slab slab = slab_of(0.0, 1.0, 0.2);
  slab.slope = -0.15;
  slab.yaw = 0.4;
  for (const Eigen::Vector3d& corner : slab.top_corners()) {
    EXPECT_NEAR(corner.z(), slab.height(corner.head<2>()), kExact);
    EXPECT_NEAR(slab.local(corner.head<2>()).cwiseAbs().x(), slab.half_size.x(), kExact);
    EXPECT_NEAR(slab.local(corner.head<2>()).cwiseAbs().y(), slab.half_size.y(), kExact);
  }
}

TEST(SlabOverlap, TouchingSlabsDoNotOverlap) {
  EXPECT_FALSE(overlap(slab_of(0.0, 1.0, 0.0), slab_of(1.0, 2.0, 0.0)));
  EXPECT_TRUE(overlap(slab_of(0.0, 1.0, 0.0), slab_of(0.999, 2.0, 0.0)));
}

TEST(SlabOverlap, ATurnedSlabMayStandWhereItsBoundingBoxWouldNot) {
  Slab turned = slab_of(1.1, 2.1, 0.0);
  turned.half_size = {0.5, 0.1};
  turned.yaw = M_PI / 4.0;
  Slab corner = slab_of(1.15, 1.35, 0.0);
  corner.centre.y() = 0.25;
  corner.half_size.y() = 0.1;
  EXPECT_FALSE(overlap(turned, corner));
  corner.centre.y() = -0.25;
  EXPECT_TRUE(overlap(turned, corner));
}

// Two rectangles share area exactly if some point lies in both: compare with dense sampling.
TEST(SlabOverlap, AgreesWithSamplingForRandomRectangles) {
  Random random(20240807);
  int overlapping = 0;
  for (int trial = 0; trial < 300; ++trial) {
    Slab a;
    Slab b;
    for (Slab* slab : {&a, &b}) {
      slab->centre = random.uniform_vector<2>();
      slab->half_size = (random.uniform_vector<2>() * 0.4).array() + 0.5;
      slab->yaw = M_PI * random.uniform();
    }
    bool found = false;
    constexpr int kGrid = 60;
    for (int i = 0; i <= kGrid && !found; ++i) {
      for (int j = 0; j <= kGrid && !found; ++j) {
        const Eigen::Vector2d p(a.half_size.x() * (2.0 * i / kGrid - 1.0),
                                a.half_size.y() * (2.0 * j / kGrid - 1.0));
        found = b.contains(a.centre + Eigen::Rotation2Dd(a.yaw) * p);
      }
    }
    if (found) {
      EXPECT_TRUE(overlap(a, b)) << "trial " << trial;
    }
    // If outlines that are 5 cm smaller overlap, a disc of 5 cm does, and the grid is finer.
    Slab smaller_a = a;
    Slab smaller_b = b;
    smaller_a.half_size.array() -= 0.05;
    smaller_b.half_size.array() -= 0.05;
    if (overlap(smaller_a, smaller_b)) {
      EXPECT_TRUE(found) << "trial " << trial;
    }
    EXPECT_EQ(overlap(a, b), overlap(b, a));
    overlapping += found ? 1 : 0;
  }
  EXPECT_GT(overlapping, 50);
  EXPECT_LT(overlapping, 250);
}

TEST(Terrain, HasNoHeightOverThePit) {
  Terrain terrain;
  terrain.slabs = {slab_of(0.0, 1.0, 0.0), slab_of(1.2, 2.0, 0.05)};
  EXPECT_EQ(terrain.top_at({0.5, 0.0}), 0.0);
  EXPECT_EQ(terrain.top_at({1.5, 0.0}), 0.05);
  EXPECT_FALSE(terrain.top_at({1.1, 0.0}));
  EXPECT_FALSE(terrain.top_at({0.5, 0.61}));
}

TEST(SupportAhead, EndsAtTheEdgeOfTheSlab) {
  Terrain terrain;
  terrain.slabs = {slab_of(0.0, 1.0, 0.0)};
  EXPECT_NEAR(*support_ahead(terrain, {0.7, 0.0}, {1.0, 0.0}), 0.3, kExact);
  EXPECT_NEAR(*support_ahead(terrain, {0.7, 0.0}, {-1.0, 0.0}), 0.7, kExact);
  const double diagonal = std::sqrt(0.5);
  EXPECT_NEAR(*support_ahead(terrain, {0.7, 0.0}, {diagonal, diagonal}), 0.3 / diagonal, kExact);
  EXPECT_FALSE(support_ahead(terrain, {1.2, 0.0}, {1.0, 0.0}));
}

TEST(SupportAhead, CrossesALevelJointButNotAStep) {
  constexpr double kProbed = 1e-5;  // the search steps over borders in micrometres
  Terrain terrain;
  terrain.slabs = {slab_of(0.0, 1.0, 0.0), slab_of(1.0, 2.0, 0.004), slab_of(2.0, 3.0, 0.05)};
  EXPECT_NEAR(*support_ahead(terrain, {0.7, 0.0}, {1.0, 0.0}), 1.3, kProbed);
  EXPECT_NEAR(*support_ahead(terrain, {2.7, 0.0}, {-1.0, 0.0}), 0.7, kProbed);
}

}  // namespace
}  // namespace hopscotch::sim
