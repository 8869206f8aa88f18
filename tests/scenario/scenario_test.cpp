#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>

#include "apps/bench.hpp"
#include "apps/lockstep_run.hpp"

namespace hopscotch::apps {
namespace {

constexpr const char* kConfig = HOPSCOTCH_SOURCE_DIR "/config/";

RunRequest request_of(const sim::Scenario& scenario, Eyes eyes, std::uint64_t seed) {
  const std::string config(kConfig);
  RunRequest request;
  request.scenario = scenario;
  request.config = ProgramConfig::load(config + "hopscotch.yaml");
  request.robot = model::RobotParameters::load(config + "robots/" + scenario.robot + ".yaml");
  request.plant_robot =
      model::RobotParameters::load(config + "robots/" + scenario.plant.robot + ".yaml");
  request.seed = seed;
  request.eyes = eyes;
  return request;
}

RunResult result_of(const RunRequest& request) {
  LockstepRun run(request);
  while (run.step({})) {
  }
  return run.result();
}

RunResult run_text(const std::string& text, Eyes eyes = Eyes::camera) {
  return result_of(request_of(sim::Scenario::from_text(text, "test"), eyes, 1));
}

class ShippedScenario : public ::testing::TestWithParam<const char*> {};

TEST_P(ShippedScenario, IsCrossedWithTheCamera) {
  const std::string file = std::string(kConfig) + "scenarios/" + GetParam() + ".yaml";
  // Any seed must do; this one is none of those that the campaign uses.
  const RunResult result = result_of(request_of(sim::Scenario::load(file), Eyes::camera, 4711));
  EXPECT_EQ(result.outcome, RunOutcome::completed) << result.reason;
  EXPECT_EQ(result.falls, 0);
  for (const JumpResult& jump : result.jumps) {
    EXPECT_EQ(jump.outcome, JumpOutcome::landed) << "jump " << jump.index << ": " << jump.reason;
    EXPECT_LE(jump.peak.torque_ratio, 1.0 + 1e-9);  // the plant enforces the limits
    EXPECT_LE(jump.peak.power_ratio, 1.0 + 1e-9);
    EXPECT_GT(jump.flight, 0.1);
  }
}

INSTANTIATE_TEST_SUITE_P(All, ShippedScenario,
                         ::testing::Values("flat-leaps", "stones", "rising-boxes", "uneven",
                                           "surprise", "jump-down"),
                         [](const auto& scenario) {
                           std::string name = scenario.param;
                           std::replace(name.begin(), name.end(), '-', '_');
                           return name;
                         });

TEST(Scenario, RisingBoxesTakeLessThanSixSeconds) {
  const RunResult result = result_of(request_of(
      sim::Scenario::load(std::string(kConfig) + "scenarios/rising-boxes.yaml"), Eyes::camera, 3));
  EXPECT_EQ(result.outcome, RunOutcome::completed);
  EXPECT_LT(result.duration, 6.0);
}

TEST(Scenario, TheHopAfterAJumpDownIsNotCalledOff) {
  // The jump down lands far ahead and rocks onto its toes.
  const RunResult result = result_of(request_of(
      sim::Scenario::load(std::string(kConfig) + "scenarios/jump-down.yaml"), Eyes::camera, 36));
  EXPECT_EQ(result.outcome, RunOutcome::completed) << result.reason;
  for (const JumpResult& jump : result.jumps) EXPECT_EQ(jump.outcome, JumpOutcome::landed);
}

void expect_upright_landings(const RunResult& result) {
  EXPECT_EQ(result.outcome, RunOutcome::completed) << result.reason;
  for (const JumpResult& jump : result.jumps) {
    EXPECT_EQ(jump.outcome, JumpOutcome::landed) << "jump " << jump.index;
    EXPECT_NEAR(jump.landing.distance, jump.target.distance, 0.05) << "jump " << jump.index;
    EXPECT_LT(jump.landing.pitch_error, 0.3) << "jump " << jump.index;
  }
}

TEST(Scenario, APushOffFromASlopeDoesNotSlip) {
  // Soles hold 0.23 of the load along the slope; plans for level ground take 0.35.
  expect_upright_landings(
      run_text("name: uphill\n"
               "friction: 0.4\n"
               "slabs:\n"
               "  - {x_m: [-1.0, 0.175]}\n"
               "  - {x_m: [0.175, 0.775], slope_rad: 0.16}\n"
               "  - {x_m: [0.775, 3.0], top_m: 0.0968}\n"
               "goal: {x_m: 0.78}\n"));
}

TEST(Scenario, ASlopeAcrossTheWayIsLandedOnAndLeft) {
  // 0.6 m along the way behind a gap of 5 cm, rising to the left, level in its middle.
  const RunResult result = run_text(
      "name: sideways\n"
      "slabs:\n"
      "  - {x_m: [-1.0, 0.175]}\n"
      "  - {x_m: [-0.075, 1.125], y_m: [-0.3, 0.3], top_m: -0.10297, slope_rad: 0.17,\n"
      "     yaw_rad: 1.5707963}\n"
      "  - {x_m: [0.875, 4.0]}\n"
      "goal: {x_m: 0.9}\n");
  expect_upright_landings(result);
  EXPECT_GE(result.jumps.size(), 3U);
}

TEST(Scenario, AGapTooWideIsRefusedStanding) {
  const RunResult result = run_text(
      "name: chasm\n"
      "slabs:\n"
      "  - {x_m: [-1.0, 0.15]}\n"
      "  - {x_m: [1.4, 3.0]}\n"
      "goal: {x_m: 1.6}\n");
  EXPECT_EQ(result.outcome, RunOutcome::refused);
  EXPECT_FALSE(result.reason.empty());
  EXPECT_EQ(result.falls, 0);
  for (const JumpResult& jump : result.jumps) EXPECT_EQ(jump.outcome, JumpOutcome::landed);
}

TEST(Scenario, AWallIsRefusedStanding) {
  const RunResult result = run_text(
      "name: wall\n"
      "slabs:\n"
      "  - {x_m: [-1.0, 0.25]}\n"
      "  - {x_m: [0.25, 3.0], top_m: 0.6}\n"
      "goal: {x_m: 1.0}\n");
  EXPECT_EQ(result.outcome, RunOutcome::refused);
  EXPECT_EQ(result.falls, 0);
}

TEST(Scenario, HeadingDoesNotMatter) {
  const RunResult result = run_text(
      "name: diagonal\n"
      "slabs:\n"
      "  - {x_m: [-2.0, 4.0], y_m: [-2.0, 4.0]}\n"
      "start: {yaw_rad: 0.6}\n"
      "goal: {jumps: 2}\n");
  EXPECT_EQ(result.outcome, RunOutcome::completed) << result.reason;
  ASSERT_EQ(result.jumps.size(), 2U);
  EXPECT_NEAR(result.jumps[1].landing.distance, result.jumps[1].target.distance, 0.04);
}

/// The promises of the estimator, on ten leaps; `hopscotch bench estimator --jumps 1000` has the
/// figures.
TEST(Scenario, TheEstimateIsGoodEnoughToLandOn) {
  const std::string config(kConfig);
  const BenchSetup setup{ProgramConfig::load(config + "hopscotch.yaml"),
                         model::RobotParameters::load(config + "robots/hector.yaml")};
  const auto score = bench_estimator(setup, 10);
  EXPECT_EQ(score["jumps"], 10);
  EXPECT_EQ(score["falls"], 0);
  EXPECT_LE(score["takeoff_speed_rmse_mps"], 0.05);
  EXPECT_LE(score["pitch_rmse_rad"], 0.026);
  EXPECT_LE(score["landing_rmse_m"], 0.03);
  EXPECT_LE(score["touchdown_ms"]["max"], 6.0);
  EXPECT_EQ(score["false_touchdowns"], 0);
  // Of six degrees of freedom: neither overconfident nor useless.
  EXPECT_LE(score["nees_of_six"], 8.0);
  EXPECT_GE(score["nees_of_six"], 0.6);
}

TEST(Scenario, TheTickTakesNothingFromTheHeap) {
  const std::string config(kConfig);
  const BenchSetup setup{ProgramConfig::load(config + "hopscotch.yaml"),
                         model::RobotParameters::load(config + "robots/hector.yaml")};
  const auto ticks = bench_tick(setup);
  EXPECT_GT(ticks["n"], 3000);
  EXPECT_EQ(ticks["allocations"], 0);
}

TEST(Scenario, AFallOfFortyCentimetresIsCaught) {
  const RunResult result = run_text(
      "name: dropped\n"
      "slabs:\n"
      "  - {x_m: [-1.0, 4.0]}\n"
      "start: {drop_m: 0.4}\n"
      "goal: {jumps: 1}\n",
      Eyes::truth);  // what the camera saw from the air is mapped too high
  EXPECT_EQ(result.outcome, RunOutcome::completed) << result.reason;
  EXPECT_EQ(result.jumps.size(), 1U);
}

TEST(Scenario, EachAblationIsDifferent) {
  RunRequest request = request_of(
      sim::Scenario::load(std::string(kConfig) + "scenarios/flat-leaps.yaml"), Eyes::truth, 2);
  request.jumps_max = 1;
  const RunResult whole = result_of(request);
  for (std::size_t i = 1; i < core::kAblationNames.size(); ++i) {
    request.ablation = static_cast<core::Ablation>(i);
    const RunResult less = result_of(request);
    ASSERT_FALSE(less.jumps.empty()) << core::kAblationNames[i];
    EXPECT_NE(less.jumps[0].peak.normal_force, whole.jumps[0].peak.normal_force)
        << core::kAblationNames[i];
    // One rigid body knows nothing of motors: only its plan breaks their limits.
    const bool broken = less.jumps[0].plan.binding_margin < -0.1;
    EXPECT_EQ(broken, request.ablation == core::Ablation::srbd_only) << core::kAblationNames[i];
  }
}

TEST(Scenario, TheTrueStateStillFlies) {
  RunRequest request = request_of(
      sim::Scenario::load(std::string(kConfig) + "scenarios/flat-leaps.yaml"), Eyes::truth, 3);
  request.state = StateSource::truth;
  const RunResult result = result_of(request);
  EXPECT_EQ(result.outcome, RunOutcome::completed) << result.reason;
  EXPECT_EQ(result.state, "truth");
  EXPECT_EQ(result.position_error, 0.0);
}

TEST(Scenario, SameSeedSameRun) {
  const std::string text =
      "name: twice\n"
      "slabs:\n"
      "  - {x_m: [-1.0, 4.0]}\n"
      "goal: {jumps: 1}\n";
  RunResult first = run_text(text);
  RunResult second = run_text(text);
  first.timing = second.timing = {};
  EXPECT_EQ(to_json(first), to_json(second));
}

/// Five leaps on level ground with less of an MPC; how many ticks on the ground after touchdown
/// held the joints stiffly, as without an answer of it.
struct Hindered {
  RunResult result;
  int unanswered = 0;
  int answered = 0;
};
/// @param declared What the controller takes the MPC's latency to be [s].
Hindered leap_hindered(int iteration_cap, double latency, double declared) {
  RunRequest request = request_of(
      sim::Scenario::load(std::string(kConfig) + "scenarios/flat-leaps.yaml"), Eyes::truth, 4711);
  request.config.control.wrench_mpc.tolerances.iteration_cap = iteration_cap;
  request.config.runtime.mpc_latency = latency;
  request.config.control.mpc_delay = declared;
  const double stiff = request.config.control.gains.fallback_scale;
  constexpr auto kKnee = core::joint_index(core::Leg::left, core::Joint::knee);
  const double knee = request.config.control.gains.kp[kKnee];
  Hindered hindered;
  LockstepRun run(request);
  while (run.step([&](const TickRecord& tick) {
    if (tick.status.phase != core::RobotPhase::landing) return;
    const double kp = tick.command.kp[kKnee];
    ++(kp > 0.99 * stiff * knee ? hindered.unanswered : hindered.answered);
  })) {
  }
  hindered.result = run.result();
  return hindered;
}

void expect_five_leaps(const RunResult& result) {
  EXPECT_EQ(result.outcome, RunOutcome::completed) << result.reason;
  EXPECT_EQ(result.falls, 0);
  ASSERT_EQ(result.jumps.size(), 5U);
  for (const JumpResult& jump : result.jumps) EXPECT_EQ(jump.outcome, JumpOutcome::landed);
}

TEST(Scenario, JumpsAreLandedWithoutAnyAnswerOfTheMpc) {
  const Hindered none = leap_hindered(1, 0.001, 0.001);  // nothing is solved in one iteration
  expect_five_leaps(none.result);
  EXPECT_GT(none.unanswered, 500);
  EXPECT_LT(none.answered, 5 * 30);  // until the lack of an answer shows
}

TEST(Scenario, JumpsAreLandedWithAnAnswerNowAndThen) {
  const Hindered some = leap_hindered(8, 0.001, 0.001);
  expect_five_leaps(some.result);
  EXPECT_GT(some.unanswered, 0);
  EXPECT_GT(some.answered, 200);
}

TEST(Scenario, JumpsAreLandedWithALateMpc) {
  const Hindered late = leap_hindered(30, 0.020, 0.020);
  expect_five_leaps(late.result);
  EXPECT_GT(late.answered, 500);
}

TEST(Scenario, JumpsAreLandedWithAnswersLaterThanDeclared) {
  const Hindered late = leap_hindered(30, 0.010, 0.001);
  expect_five_leaps(late.result);
  EXPECT_GT(late.answered, 500);
}

TEST(Scenario, AnswersThatAreTooOldAreRefusedAndJumpsLandedAllTheSame) {
  const Hindered late = leap_hindered(30, 0.030, 0.001);
  expect_five_leaps(late.result);
  EXPECT_GT(late.unanswered, 500);
  EXPECT_LT(late.answered, 5 * 30);
}

TEST(Scenario, AJumpThatAlwaysGoesWrongIsGivenUpStanding) {
  RunRequest request = request_of(
      sim::Scenario::load(std::string(kConfig) + "scenarios/flat-leaps.yaml"), Eyes::truth, 4711);
  request.config.control.supervisor.stray_max = 1e-4;  // no crouch is as good as that [m]
  LockstepRun run(request);
  while (run.step({})) {
  }
  const RunResult result = run.result();
  EXPECT_EQ(result.outcome, RunOutcome::refused) << result.reason;
  EXPECT_NE(result.reason.find("4 jumps in a row"), std::string::npos) << result.reason;
  EXPECT_EQ(result.falls, 0);
}

TEST(Scenario, SlopesUpAndDownAreCrossed) {
  for (const double slope : {0.14, -0.16}) {
    const double far = 0.60 * std::tan(slope);
    const RunResult result = run_text(
        "name: ramp\n"
        "slabs:\n"
        "  - {x_m: [-1.0, 0.175]}\n"
        "  - {x_m: [0.175, 0.775], slope_rad: " +
            std::to_string(slope) +
            "}\n"
            "  - {x_m: [0.775, 3.775], top_m: " +
            std::to_string(far) +
            "}\n"
            "goal: {x_m: 0.90}\n",
        Eyes::truth);
    EXPECT_EQ(result.outcome, RunOutcome::completed) << slope << ": " << result.reason;
    for (const JumpResult& jump : result.jumps) {
      EXPECT_EQ(jump.outcome, JumpOutcome::landed) << slope << ": jump " << jump.index;
    }
  }
}

TEST(Scenario, AHardPushInFlightIsSeenAsAFall) {
  const RunResult result = run_text(
      "name: pushed-over\n"
      "slabs:\n"
      "  - {x_m: [-1.0, 4.0]}\n"
      "goal: {jumps: 3}\n"
      "surprises:\n"
      "  - {push: {phase: flight, after_s: 0.05, duration_s: 0.1, impulse_Ns: [0.0, 40.0, 0.0]}}\n",
      Eyes::truth);
  EXPECT_EQ(result.outcome, RunOutcome::fell);
  EXPECT_EQ(result.falls, 1);
}

/// What is left of jumps, planned from where the robot is.
struct ReplannedJumps {
  int replanned = 0;
  int ticks = 0;  ///< In which a rest could be planned.
  RunResult result;
};

/// @param may_replan Of a tick.
template <typename Predicate>
ReplannedJumps run_replanned(bool takeoff, bool landing, const Predicate& may_replan) {
  RunRequest request = request_of(
      sim::Scenario::load(std::string(kConfig) + "scenarios/flat-leaps.yaml"), Eyes::truth, 4711);
  request.config.runtime.takeoff_replanning = takeoff;
  request.config.runtime.landing_replanning = landing;
  request.jumps_max = 2;
  LockstepRun run(request);
  ReplannedJumps jumps;
  while (run.step([&](const TickRecord& tick) {
    jumps.replanned += tick.events.replanned ? 1 : 0;
    jumps.ticks += may_replan(tick) ? 1 : 0;
  })) {
  }
  EXPECT_EQ(run.pipeline().late_results(), 0U);
  jumps.result = run.result();
  EXPECT_EQ(jumps.result.falls, 0) << jumps.result.reason;
  EXPECT_EQ(jumps.result.jumps.size(), 2U);
  int told = 0;
  for (const JumpResult& jump : jumps.result.jumps) {
    EXPECT_NEAR(jump.landing.distance, jump.target.distance, 0.03);
    told += jump.plan.replanned;
  }
  EXPECT_EQ(told, jumps.replanned);
  EXPECT_GT(jumps.result.timing.replan_ms.p50, 0.0);
  return jumps;
}

constexpr double kReplanRate = 50.0;  // at least [1/s]

TEST(Replanning, OfATakeoffIsInTimeAndLandsAtTheTarget) {
  const ReplannedJumps jumps = run_replanned(true, false, [](const TickRecord& tick) {
    const bool leaves = tick.status.plan_time > tick.plan.liftoff_time - 0.05;
    return core::is_pushing_off(tick.status.phase) && !leaves;
  });
  EXPECT_GE(jumps.replanned, kReplanRate * 0.001 * jumps.ticks);
}

TEST(Replanning, OfALandingIsInTimeAndEndsAtRest) {
  const ReplannedJumps jumps = run_replanned(false, true, [](const TickRecord& tick) {
    const double since = tick.status.plan_time - tick.plan.touchdown_time;
    const double left = tick.plan.duration - tick.status.plan_time;
    return tick.status.phase == core::RobotPhase::landing && since > 0.03 && left > 0.15;
  });
  EXPECT_GE(jumps.replanned, kReplanRate * 0.001 * jumps.ticks);
}

}  // namespace
}  // namespace hopscotch::apps
