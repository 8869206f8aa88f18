#include "planner/certificate.hpp"

#include <gtest/gtest.h>

#include <set>
#include <string>

#include "planner/certified_plan.hpp"
#include "tests/unit/planner/solved_jump.hpp"

namespace hopscotch::planner {
namespace {

using testing_support::level_jump;
using testing_support::SolvedJump;

double margin(const core::Certificate& certificate, std::string_view name) {
  for (std::size_t i = 0; i < certificate.count; ++i) {
    if (certificate.entries[i].name == name) return certificate.entries[i].margin;
  }
  return core::kNaN;
}

TEST(Certificate, OfASolvedJumpHasNoNegativeMargin) {
  const SolvedJump& jump = level_jump();
  const CertifiedMotion certified = certify(jump.model, jump.task, jump.motion);
  EXPECT_GT(certified.certificate.binding().margin, 0.0);
  EXPECT_LT(certified.certificate.dense_max_violation, 0.05);
  std::set<std::string_view> names;
  for (std::size_t i = 0; i < certified.certificate.count; ++i) {
    names.insert(certified.certificate.entries[i].name);
  }
  EXPECT_EQ(names.size(), certified.certificate.count);
  for (const char* name :
       {"knee torque", "knee power", "friction", "toe pressure", "normal force", "toe clearance"}) {
    EXPECT_TRUE(names.contains(name)) << name;
  }
}

TEST(Certificate, FindsAMotorThatIsTooWeak) {
  SolvedJump jump = level_jump();
  jump.model.robot.motors[core::index(core::Joint::knee)].torque_max *= 0.3;
  const CertifiedMotion certified = certify(jump.model, jump.task, jump.motion);
  EXPECT_LT(margin(certified.certificate, "knee torque"), 0.0);
  EXPECT_GT(certified.certificate.dense_max_violation, 0.3);
}

TEST(Certificate, FindsSlipperyGround) {
  SolvedJump jump = level_jump();
  jump.model.config.friction = 0.1;
  const CertifiedMotion certified = certify(jump.model, jump.task, jump.motion);
  EXPECT_LT(margin(certified.certificate, "friction"), 0.0);
  EXPECT_EQ(certified.certificate.binding().name, "friction");
}

TEST(Certificate, FindsAWallInTheWay) {
  SolvedJump jump = level_jump();
  PlanRequest blocked = testing_support::request(0.40, 0.0);
  for (double x = 0.15; x < 0.25; x += 0.01) {
    blocked.target.profile.upper[static_cast<std::size_t>(core::TerrainProfile::sample(x))] = 0.2;
  }
  const core::Result<PlanarTask> task = planar_task(jump.model, blocked);
  ASSERT_TRUE(task);
  const CertifiedMotion certified = certify(jump.model, *task, jump.motion);
  EXPECT_LT(margin(certified.certificate, "toe clearance"), 0.0);
  EXPECT_GT(certified.certificate.dense_max_violation, 0.5);
}

TEST(Certificate, FindsGroundBehindTheTargetThatTheShanksLeanOn) {
  SolvedJump jump = level_jump();
  const CertifiedMotion open = certify(jump.model, jump.task, jump.motion);
  EXPECT_GT(margin(open.certificate, "shank clearance"), 0.0);
  PlanRequest below = testing_support::request(0.40, 0.0);
  for (double x = 0.15; x < 0.27; x += 0.01) {  // behind the ankle, which lands at 0.39 m
    below.target.profile.upper[static_cast<std::size_t>(core::TerrainProfile::sample(x))] = 0.15;
  }
  const core::Result<PlanarTask> task = planar_task(jump.model, below);
  ASSERT_TRUE(task) << task.error().text();
  const CertifiedMotion certified = certify(jump.model, *task, jump.motion);
  EXPECT_LT(margin(certified.certificate, "shank clearance"), 0.0);
}

TEST(Certificate, FindsAMotionThatTheTorquesDoNotMake) {
  SolvedJump jump = level_jump();
  // A jump of the rates inside the push that no torque of the step explains.
  jump.motion.knots[10].acceleration[model::kTrunk] += 200.0;
  const CertifiedMotion certified = certify(jump.model, jump.task, jump.motion);
  EXPECT_LT(certified.certificate.binding().margin, 0.0);
}

TEST(Certificate, PeaksAgreeWithTheMargins) {
  const SolvedJump& jump = level_jump();
  const CertifiedMotion certified = certify(jump.model, jump.task, jump.motion);
  const double torque = std::min({margin(certified.certificate, "hip torque"),
                                  margin(certified.certificate, "knee torque"),
                                  margin(certified.certificate, "ankle torque")});
  EXPECT_NEAR(certified.peaks.torque_ratio, 1.0 - torque, 1e-12);
  EXPECT_GT(certified.peaks.normal_force,
            jump.model.dynamics.chain().total_mass() * model::kGravity);
}

/// Two limits, of which the second has less margin.
core::Certificate with_margins(double first, double second, double dense_violation) {
  core::Certificate certificate;
  certificate.entries[0] = {.name = "knee power", .margin = first, .time = 0.4};
  certificate.entries[1] = {.name = "friction", .margin = second, .time = 0.1};
  certificate.count = 2;
  certificate.dense_max_violation = dense_violation;
  return certificate;
}

TEST(CertificateBreach, NamesTheWorstLimitElseTheDynamics) {
  EXPECT_FALSE(certificate_breach(with_margins(0.1, 0.0, 0.0)));
  EXPECT_FALSE(certificate_breach(with_margins(0.1, -9e-4, 9e-4))) << "rounding";
  const auto limit = certificate_breach(with_margins(-0.1, -0.2, 0.2));
  ASSERT_TRUE(limit);
  EXPECT_EQ(limit->sentence, "friction has margin -0.200 at 0.100 s");
  const auto dynamics = certificate_breach(with_margins(0.1, 0.2, 0.0012));
  ASSERT_TRUE(dynamics);
  EXPECT_EQ(dynamics->sentence,
            "integrated at 1 ms, the motion misses its knots by 0.0012, allowed is 0.0010");
}

}  // namespace
}  // namespace hopscotch::planner
