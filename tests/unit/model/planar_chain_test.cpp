#include "model/planar_chain.hpp"

#include <gtest/gtest.h>

#include "core/robot_layout.hpp"
#include "tests/unit/model/robots.hpp"

namespace hopscotch::model {
namespace {

// The published table is rounded to 1e-5 kg, 1e-6 m and 1e-7 kg m^2; so are the links it came from.
constexpr double kMass = 1e-9;
constexpr double kLength = 1.1e-6;
constexpr double kInertia = 1.1e-7;

void expect_link(const PlanarLink& link, const PlanarLink& published) {
  EXPECT_NEAR(link.mass, published.mass, kMass);
  EXPECT_NEAR(link.com_x, published.com_x, kLength);
  EXPECT_NEAR(link.com_z, published.com_z, kLength);
  EXPECT_NEAR(link.inertia, published.inertia, kInertia);
  EXPECT_DOUBLE_EQ(link.length, published.length);
}

TEST(PlanarChain, SetRMatchesThePublishedTable) {
  const PlanarChain chain = lump_legs(load_robot("hector"));
  expect_link(chain.foot, {0.42800, 0.010569, -0.017118, 0.0005815, 0.0});
  expect_link(chain.shank, {0.60600, 0.0, 0.105900, 0.0038208, 0.22});
  expect_link(chain.thigh, {3.88400, -0.000049, 0.161387, 0.0190471, 0.22});
  expect_link(chain.trunk, {9.12800, 0.024337, 0.129364, 0.1244501, 0.0});
  EXPECT_DOUBLE_EQ(chain.trunk_x, 0.0135);
  EXPECT_DOUBLE_EQ(chain.trunk_z, 0.197);
  EXPECT_DOUBLE_EQ(chain.sole_height, 0.04);
}

TEST(PlanarChain, SetD14MatchesThePublishedTable) {
  const PlanarChain chain = lump_legs(load_robot("hector-d14"));
  expect_link(chain.foot, {0.16850, 0.002390, -0.022610, 0.0002200, 0.0});
  expect_link(chain.shank, {0.43400, 0.013200, 0.153799, 0.0020718, 0.22});
  expect_link(chain.thigh, {3.37600, 0.000691, 0.168246, 0.0134587, 0.22});
  expect_link(chain.trunk, {10.02150, 0.028322, 0.141655, 0.1524806, 0.0});
  EXPECT_DOUBLE_EQ(chain.trunk_x, 0.021);
  EXPECT_DOUBLE_EQ(chain.trunk_z, 0.1975);
  EXPECT_DOUBLE_EQ(chain.sole_height, 0.039);
}

TEST(PlanarChain, HoldsTheWholeMass) {
  for (const char* name : {"hector", "hector-d14"}) {
    const RobotParameters robot = load_robot(name);
    EXPECT_NEAR(lump_legs(robot).total_mass(), robot.total_mass(), 1e-12);
  }
}

TEST(PlanarChain, RotorsAndDampersOfBothLegsCount) {
  const RobotParameters robot = load_robot("hector");
  const PlanarChain chain = lump_legs(robot);
  EXPECT_DOUBLE_EQ(chain.armature_hip, 0.02);
  EXPECT_DOUBLE_EQ(chain.armature_knee, 0.08);
  EXPECT_DOUBLE_EQ(chain.armature_ankle, 0.02);
  EXPECT_DOUBLE_EQ(chain.damping_knee, 2.0 * robot.joints[core::index(core::Joint::knee)].damping);
}

}  // namespace
}  // namespace hopscotch::model
