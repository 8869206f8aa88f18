#include "sim/judge.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "model/kinematics.hpp"

namespace hopscotch::sim {
namespace {

constexpr double kExact = 1e-9;

model::RobotParameters hector() {
  return model::RobotParameters::load(std::string(HOPSCOTCH_SOURCE_DIR) +
                                      "/config/robots/hector.yaml");
}

Slab slab_of(double x0, double x1, double top) {
  Slab slab;
  slab.centre = {0.5 * (x0 + x1), 0.0};
  slab.half_size = {0.5 * (x1 - x0), 0.6};
  slab.top = top;
  return slab;
}

/// Standing with the mid-point of the soles at `middle`, turned by `yaw`.
PlantTruth standing_at(const Eigen::Vector3d& middle, double yaw) {
  PlantTruth truth;
  const Eigen::Matrix3d R = model::rotation_from_rpy({0.0, 0.0, yaw});
  truth.state.R_WB = R;
  truth.state.p_WB = middle + Eigen::Vector3d(0.0, 0.0, 0.548);
  for (const core::Leg leg : core::kAllLegs) {
    const double y = leg == core::Leg::left ? 0.098 : -0.098;
    Eigen::Isometry3d& X_WF = truth.X_WF[core::index(leg)];
    X_WF.linear() = R;
    X_WF.translation() = middle + R * Eigen::Vector3d(0.0, y, 0.0);
  }
  return truth;
}

TEST(Judge, AStandingRobotHasNotFallen) {
  EXPECT_FALSE(fall_of(standing_at({0.0, 0.0, 0.0}, 0.3)));
}

TEST(Judge, AnythingButAFootOnTheGroundIsAFallAndIsNamed) {
  PlantTruth truth = standing_at({0.0, 0.0, 0.0}, 0.0);
  truth.body_contacts.push_back(
      {.part = "left_shank", .ground = "slab3.top", .normal_force = 12.34});
  EXPECT_EQ(fall_of(truth), "left_shank touches slab3.top with 12.34 N");
}

TEST(Judge, AFootInThePitIsAFall) {
  PlantTruth truth = standing_at({0.0, 0.0, -0.5}, 0.0);
  truth.foot_in_pit = true;
  EXPECT_EQ(fall_of(truth), "a foot is on the floor of the pit");
}

TEST(Judge, ALeanOfNinetyHundredthsIsLegitimateAndOneAndAHalfIsNot) {
  PlantTruth truth = standing_at({0.0, 0.0, 0.0}, 0.0);
  truth.state.R_WB = model::rotation_from_rpy({0.0, 0.9, 1.0});
  EXPECT_FALSE(fall_of(truth));
  truth.state.R_WB = model::rotation_from_rpy({1.5, 0.0, 1.0});
  EXPECT_EQ(fall_of(truth), "the trunk is tilted by 1.50 rad");
}

TEST(Judge, ATrunkAtTheHeightOfItsSolesLies) {
  PlantTruth truth = standing_at({0.0, 0.0, 0.2}, 0.0);
  truth.state.p_WB.z() = 0.3;
  EXPECT_EQ(fall_of(truth), "the trunk is only 0.10 m above the lower sole");
}

TEST(Judge, DistanceAndHeightAreMeasuredInTheTakeoffFrame) {
  const double yaw = 0.7;
  Terrain terrain;
  terrain.slabs = {slab_of(-2.0, 3.0, 0.0)};
  const PlantTruth before = standing_at({0.3, 0.1, 0.0}, yaw);
  const TakeoffPlace place = takeoff_place(before);
  EXPECT_NEAR(place.heading, yaw, kExact);
  const Eigen::Vector3d jump =
      model::rotation_from_rpy({0.0, 0.0, yaw}) * Eigen::Vector3d(0.4, 0.02, 0.05);
  const PlantTruth after = standing_at(Eigen::Vector3d(0.3, 0.1, 0.0) + jump, yaw + 0.1);
  const LandingVerdict verdict = judge_landing(terrain, hector(), place, after);
  EXPECT_NEAR(verdict.distance, 0.4, kExact);
  EXPECT_NEAR(verdict.lateral, 0.02, kExact);
  EXPECT_NEAR(verdict.height, 0.05, kExact);
}

TEST(Judge, MarginsAreTheSupportLeftAheadOfToeAndBehindHeel) {
  Terrain terrain;
  terrain.slabs = {slab_of(1.0, 1.3, 0.0)};
  const PlantTruth rest = standing_at({1.17, 0.0, 0.0}, 0.0);
  const LandingVerdict verdict =
      judge_landing(terrain, hector(), takeoff_place(standing_at({0.7, 0.0, 0.0}, 0.0)), rest);
  EXPECT_NEAR(verdict.toe_margin, 1.3 - (1.17 + 0.075), kExact);
  EXPECT_NEAR(verdict.heel_margin, (1.17 - 0.075) - 1.0, kExact);
  EXPECT_FALSE(verdict.over_edge);
}

TEST(Judge, FiveMillimetresOverAnEdgeAreAllowedAndNoMore) {
  Terrain terrain;
  terrain.slabs = {slab_of(1.0, 1.3, 0.0)};
  const TakeoffPlace from = takeoff_place(standing_at({0.7, 0.0, 0.0}, 0.0));
  const auto over = [&](double x) {
    return judge_landing(terrain, hector(), from, standing_at({x, 0.0, 0.0}, 0.0));
  };
  EXPECT_FALSE(over(1.3 - 0.075 + 0.0049).over_edge);
  EXPECT_TRUE(over(1.3 - 0.075 + 0.0051).over_edge);
  EXPECT_NEAR(over(1.3 - 0.075 + 0.03).toe_margin, -0.03, kExact);
  EXPECT_FALSE(over(1.0 + 0.075 - 0.0049).over_edge);
  EXPECT_TRUE(over(1.0 + 0.075 - 0.0051).over_edge);
  EXPECT_NEAR(over(1.3 + 0.05).toe_margin, -0.125, kExact);   // only the heel is supported
  EXPECT_NEAR(over(1.0 - 0.05).heel_margin, -0.125, kExact);  // only the toe is supported
  EXPECT_NEAR(over(1.5).toe_margin, -0.15, kExact);           // nothing is supported
}

TEST(Judge, TheWorseFootCounts) {
  Terrain terrain;
  terrain.slabs = {slab_of(1.0, 1.3, 0.0)};
  PlantTruth rest = standing_at({1.17, 0.0, 0.0}, 0.0);
  rest.X_WF[1].translation().x() += 0.07;
  const LandingVerdict verdict =
      judge_landing(terrain, hector(), takeoff_place(standing_at({0.7, 0.0, 0.0}, 0.0)), rest);
  EXPECT_NEAR(verdict.toe_margin, 1.3 - (1.24 + 0.075), kExact);
  EXPECT_TRUE(verdict.over_edge);
}

TEST(Judge, TheGoalIsReachedByTheRearHeelAlongTheHeading) {
  const model::RobotParameters robot = hector();
  PlantTruth truth = standing_at({2.0, 0.0, 0.0}, 0.0);
  truth.X_WF[0].translation().x() -= 0.03;
  EXPECT_NEAR(heel_progress(robot, truth, 0.0), 2.0 - 0.03 - 0.075, kExact);
  const PlantTruth turned = standing_at({0.0, 3.0, 0.0}, M_PI / 2.0);
  EXPECT_NEAR(heel_progress(robot, turned, M_PI / 2.0), 3.0 - 0.075, kExact);
}

TEST(LoadPeaks, KeepTheLargestOfEachKind) {
  PlantTruth truth = standing_at({0.0, 0.0, 0.0}, 0.0);
  for (model::MotorLoad& load : truth.load) {
    load.torque_ratio.setConstant(0.2);
    load.speed_ratio.setConstant(0.3);
    load.power_ratio.setConstant(0.4);
  }
  truth.load[1].speed_ratio[3] = 0.9;
  truth.motor_power[8] = -250.0;
  truth.ground[0].force.z() = 200.0;
  truth.ground[1].force.z() = 150.0;
  LoadPeaks peaks;
  peaks.include(truth);
  truth.load[1].speed_ratio[3] = 0.1;
  truth.ground[0].force.z() = 0.0;
  peaks.include(truth);
  EXPECT_DOUBLE_EQ(peaks.torque_ratio, 0.2);
  EXPECT_DOUBLE_EQ(peaks.speed_ratio, 0.9);
  EXPECT_DOUBLE_EQ(peaks.power_ratio, 0.4);
  EXPECT_DOUBLE_EQ(peaks.braking_power, 250.0);
  EXPECT_DOUBLE_EQ(peaks.normal_force, 350.0);
}

}  // namespace
}  // namespace hopscotch::sim
