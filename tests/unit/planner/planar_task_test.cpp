#include "planner/planar_task.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "model/kinematics.hpp"
#include "tests/unit/planner/planner_fixture.hpp"

namespace hopscotch::planner {
namespace {

using testing_support::request;
using testing_support::shipped_model;

constexpr double kRounding = 1e-9;

TEST(PlanarTask, StandingRobotIsInItsStandPosture) {
  const PlanarModel model = shipped_model();
  const core::Result<PlanarTask> task = planar_task(model, request(0.4, 0.1));
  ASSERT_TRUE(task);
  for (std::size_t j = 0; j < model::kPlanarLinks; ++j) {
    EXPECT_NEAR(task->start.pitch[j], task->final_posture[j], kRounding);
    EXPECT_NEAR(task->start.rate[j], 0.0, kRounding);
  }
}

TEST(PlanarTask, AveragesTheLegs) {
  const PlanarModel model = shipped_model();
  PlanRequest uneven = request(0.4, 0.0);
  uneven.start.q(core::joint_index(core::Leg::left, core::Joint::knee)) += 0.02;
  uneven.start.q(core::joint_index(core::Leg::right, core::Joint::knee)) -= 0.02;
  const core::Result<PlanarTask> task = planar_task(model, uneven);
  ASSERT_TRUE(task);
  EXPECT_NEAR(task->start.pitch[model::kShank], task->final_posture[model::kShank], kRounding);
}

TEST(PlanarTask, OfAJumpThatIsDownStartsAtItsTarget) {
  const PlanarModel model = shipped_model();
  PlanRequest landed = request(0.4, 0.1);
  EXPECT_FALSE(planar_task(model, landed, FeetPlace::target)) << "its feet are at the origin";
  landed.start.p_WB += Eigen::Vector3d(0.41, 0.0, 0.1);
  EXPECT_FALSE(planar_task(model, landed));
  const core::Result<PlanarTask> task = planar_task(model, landed, FeetPlace::target);
  ASSERT_TRUE(task);
  EXPECT_NEAR(task->start.pitch[model::kShank], task->final_posture[model::kShank], kRounding);
  EXPECT_EQ(task->distance, 0.4);
}

TEST(PlanarTask, DoesNotDependOnTheHeading) {
  const PlanarModel model = shipped_model();
  const PlanRequest straight = request(0.4, 0.0);
  PlanRequest turned = straight;
  const Eigen::Isometry3d turn =
      Eigen::Translation3d(1.0, -2.0, 0.3) * Eigen::AngleAxisd(0.9, Eigen::Vector3d::UnitZ());
  turned.start.p_WB = turn * straight.start.p_WB;
  turned.start.R_WB = turn.linear() * straight.start.R_WB;
  turned.start.w_WB = turn.linear() * Eigen::Vector3d(0.0, 0.3, 0.0);
  turned.target.p_WS = turn.translation();
  turned.target.heading = 0.9;
  for (Eigen::Isometry3d& X_WF : turned.target.X_WF) X_WF = turn * X_WF;
  const core::Result<PlanarTask> task = planar_task(model, turned);
  ASSERT_TRUE(task) << task.error().text();
  EXPECT_NEAR(task->start.pitch[model::kTrunk], task->final_posture[model::kTrunk], kRounding);
  EXPECT_NEAR(task->start.rate[model::kTrunk], 0.3, kRounding);
}

struct BadRequest {
  const char* name;
  void (*spoil)(PlanRequest&);
  core::Reason reason;
};

class BadRequests : public testing::TestWithParam<BadRequest> {};

TEST_P(BadRequests, AreRefusedByName) {
  PlanRequest bad = request(0.4, 0.0);
  GetParam().spoil(bad);
  const core::Result<PlanarTask> task = planar_task(shipped_model(), bad);
  ASSERT_FALSE(task);
  EXPECT_EQ(task.error().reason, GetParam().reason);
  EXPECT_FALSE(task.error().sentence.empty());
}

INSTANTIATE_TEST_SUITE_P(
    All, BadRequests,
    testing::Values(
        BadRequest{"NaN distance", [](PlanRequest& r) { r.target.distance = core::kNaN; },
                   core::Reason::target_malformed},
        BadRequest{"NaN height", [](PlanRequest& r) { r.target.height = core::kNaN; },
                   core::Reason::target_malformed},
        BadRequest{"NaN frame", [](PlanRequest& r) { r.target.p_WS.x() = core::kNaN; },
                   core::Reason::target_malformed},
        BadRequest{"backward", [](PlanRequest& r) { r.target.distance = -0.3; },
                   core::Reason::target_malformed},
        BadRequest{"far", [](PlanRequest& r) { r.target.distance = 5.0; },
                   core::Reason::target_malformed},
        BadRequest{"high", [](PlanRequest& r) { r.target.height = 2.0; },
                   core::Reason::target_malformed},
        BadRequest{"lateral",
                   [](PlanRequest& r) {
                     for (Eigen::Isometry3d& X : r.target.X_WF) X.translation().y() += 0.2;
                   },
                   core::Reason::target_malformed},
        BadRequest{"turned",
                   [](PlanRequest& r) {
                     for (Eigen::Isometry3d& X : r.target.X_WF) {
                       X.rotate(Eigen::AngleAxisd(0.5, Eigen::Vector3d::UnitZ()));
                     }
                   },
                   core::Reason::target_malformed},
        BadRequest{"NaN pose",
                   [](PlanRequest& r) { r.target.X_WF[0].translation().y() = core::kNaN; },
                   core::Reason::target_malformed},
        BadRequest{"unknown ground",
                   [](PlanRequest& r) {
                     r.target.profile.upper.fill(std::numeric_limits<double>::infinity());
                   },
                   core::Reason::target_malformed},
        BadRequest{"inside a pit",
                   [](PlanRequest& r) {
                     for (double x = 0.3; x < 0.5; x += 0.01) {
                       const auto at = static_cast<std::size_t>(core::TerrainProfile::sample(x));
                       r.target.profile.lower[at] = r.target.profile.mean[at] = -0.5;
                       r.target.profile.upper[at] = -0.5;
                     }
                   },
                   core::Reason::target_malformed},
        BadRequest{"step under the toes",
                   [](PlanRequest& r) {
                     r.target = step_target({.distance = 0.18, .height = 0.1, .edge = 0.06},
                                            testing_support::hector());
                   },
                   core::Reason::target_malformed},
        BadRequest{"step close ahead",
                   [](PlanRequest& r) {
                     r.target = step_target({.distance = 0.21, .height = 0.2, .edge = 0.09},
                                            testing_support::hector());
                   },
                   core::Reason::target_malformed},
        BadRequest{"drop under the heels",
                   [](PlanRequest& r) {
                     r.target = step_target({.distance = 0.21, .height = -0.15, .edge = 0.12},
                                            testing_support::hector());
                   },
                   core::Reason::target_malformed},
        BadRequest{"inside a wall",
                   [](PlanRequest& r) {
                     const auto at = static_cast<std::size_t>(core::TerrainProfile::sample(0.35));
                     r.target.profile.upper[at] = 0.1;
                   },
                   core::Reason::target_malformed},
        BadRequest{"NaN joint", [](PlanRequest& r) { r.start.q(3) = core::kNaN; },
                   core::Reason::bad_sensor_value},
        BadRequest{"NaN rate", [](PlanRequest& r) { r.start.w_WB.y() = core::kNaN; },
                   core::Reason::bad_sensor_value},
        BadRequest{"elsewhere", [](PlanRequest& r) { r.start.p_WB.x() += 0.5; },
                   core::Reason::target_malformed},
        BadRequest{"impossible posture", [](PlanRequest& r) { r.final_posture.com_height = 0.9; },
                   core::Reason::out_of_reach}),
    [](const testing::TestParamInfo<BadRequest>& bad) {
      std::string name = bad.param.name;
      for (char& c : name) c = c == ' ' ? '_' : c;
      return name;
    });

}  // namespace
}  // namespace hopscotch::planner
