#include "perception/body_mask.hpp"

#include <gtest/gtest.h>

#include "model/kinematics.hpp"
#include "tests/unit/perception/synthetic_terrain.hpp"

namespace hopscotch::perception {
namespace {

constexpr double kRounding = 1e-12;  // of a few multiplications of numbers near one

TEST(BodyMask, LinksHangTogetherAtTheJoints) {
  const core::RobotState state = test::standing_at({}, 0.0, 0.0, 0.0);
  const BodyCapsules body =
      body_in_camera(test::hector(), state.q, test::empty_frame(64, 48, 0.0).X_BC);
  for (const std::size_t thigh : {std::size_t{0}, std::size_t{3}}) {
    EXPECT_NEAR((body[thigh].end - body[thigh + 1].start).norm(), 0.0, kRounding);
    const double shank = (body[thigh + 1].end - body[thigh + 1].start).norm();
    EXPECT_NEAR(shank, 0.22, 0.01) << "shank length of the fact sheet, give or take the offset";
  }
}

TEST(BodyMask, FeetLieOnTheirSoles) {
  const model::RobotParameters robot = test::hector();
  const core::RobotState state = test::standing_at({}, 0.0, 0.0, 0.0);
  const Eigen::Isometry3d X_BC = test::empty_frame(64, 48, 0.0).X_BC;
  const BodyCapsules body = body_in_camera(robot, state.q, X_BC);
  for (const core::Leg leg : core::kAllLegs) {
    const Capsule& foot = body[3 * core::index(leg) + 2];
    const core::LegVector q = state.q.segment<5>(core::leg_offset(leg));
    const Eigen::Isometry3d X_CF = X_BC.inverse() * model::leg_poses(robot, leg, q).X_BF;
    const Eigen::Vector3d middle = 0.5 * (foot.start + foot.end);
    EXPECT_NEAR((X_CF.inverse() * middle - Eigen::Vector3d(0, 0, foot.radius)).norm(), 0.0,
                kRounding);
    EXPECT_NEAR((foot.end - foot.start).norm(), robot.toe + robot.heel, kRounding);
  }
}

}  // namespace
}  // namespace hopscotch::perception
