// What becomes of an operator's target by the moment at which it comes: before take-off it takes
// the place of what was chosen, from then until the landing the jump is locked.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "apps/lockstep_run.hpp"

namespace hopscotch::apps {
namespace {

using core::Reason;
using core::RobotPhase;

/// Three jumps on level ground, seen by the camera.
class LockedJump : public ::testing::Test {
 protected:
  LockedJump() : run_(request()) {}

  static RunRequest request() {
    const std::string config = HOPSCOTCH_SOURCE_DIR "/config/";
    RunRequest request;
    request.scenario = sim::Scenario::from_text(
        "name: level\ncamera: {width: 320, height: 240}\nslabs: [{x_m: [-1.0, 6.0]}]\n"
        "goal: {jumps: 3}\n",
        "level");
    request.config = ProgramConfig::load(config + "hopscotch.yaml");
    request.robot = model::RobotParameters::load(config + "robots/hector.yaml");
    request.plant_robot = request.robot;
    request.seed = 5;
    return request;
  }

  bool step() {
    return run_.step([&](const TickRecord& tick) {
      jump_ = tick.jump;
      phase_ = tick.status.phase;
      plan_ = tick.plan;
      for (const core::OperatorAnswer& answer : tick.events.answers) answers_.push_back(answer);
      planned_ = planned_ || tick.events.plan.has_value();
    });
  }
  /// Into this phase of this jump.
  void go_to(int jump, RobotPhase phase) {
    while (!(jump_ == jump && phase_ == phase)) {
      ASSERT_TRUE(step()) << run_.result().reason;
    }
  }
  void run_for(int ticks) {
    for (int i = 0; i < ticks; ++i) ASSERT_TRUE(step()) << run_.result().reason;
  }
  RunResult run_to_end() {
    while (step()) {
    }
    return run_.result();
  }
  /// @return when it is answered, in ticks.
  int ask(double distance) {
    core::OperatorCommand command;
    command.sequence = ++asked_;
    command.target = core::TargetOverride{.distance = distance};
    answers_.clear();
    run_.apply(command);
    int ticks = 0;
    for (; answers_.empty() && ticks < 2000 && step(); ++ticks) {
    }
    return ticks;
  }

  LockstepRun run_;
  int jump_ = 0;
  RobotPhase phase_ = RobotPhase::stand;
  core::JumpPlan plan_;
  bool planned_ = false;
  std::vector<core::OperatorAnswer> answers_;
  std::uint64_t asked_ = 0;
};

class LockedJumpIn : public LockedJump, public ::testing::WithParamInterface<RobotPhase> {};

TEST_P(LockedJumpIn, RefusesAnOverrideAndFliesToItsOwnTarget) {
  RunResult undisturbed;
  {
    LockstepRun other(request());
    while (other.step({})) {
    }
    undisturbed = other.result();
  }
  go_to(2, GetParam());
  if (HasFatalFailure()) return;
  const std::uint64_t id = plan_.id;
  const double distance = plan_.target.distance;
  EXPECT_LE(ask(distance + 0.08), 1) << "at once";
  ASSERT_EQ(answers_.size(), 1U);
  EXPECT_EQ(answers_[0].refusal.reason, Reason::not_now);
  EXPECT_NE(answers_[0].refusal.sentence.find("locked"), std::string::npos);
  EXPECT_GT(answers_[0].start_in, 0.0) << "when it may be asked again";
  EXPECT_LT(answers_[0].start_in, 1.0);
  EXPECT_EQ(plan_.id, id);
  EXPECT_EQ(plan_.target.distance, distance);

  RunResult result = run_to_end();
  result.timing = undisturbed.timing = {};
  EXPECT_EQ(to_json(result), to_json(undisturbed)) << "as if nobody had asked";
}

INSTANTIATE_TEST_SUITE_P(FromTakeOffOn, LockedJumpIn,
                         ::testing::Values(RobotPhase::crouch, RobotPhase::takeoff,
                                           RobotPhase::flight),
                         [](const auto& phase) {
                           return std::string(core::robot_phase_name(phase.param));
                         });

TEST_F(LockedJump, TakesATargetAgainOnceItHasLanded) {
  go_to(1, RobotPhase::flight);
  if (HasFatalFailure()) return;
  (void)ask(0.30);
  ASSERT_EQ(answers_.size(), 1U);
  EXPECT_FALSE(answers_[0].accepted());
  go_to(1, RobotPhase::landing);
  if (HasFatalFailure()) return;
  (void)ask(0.30);
  ASSERT_EQ(answers_.size(), 1U);
  EXPECT_TRUE(answers_[0].accepted()) << answers_[0].refusal.sentence;
  const RunResult result = run_to_end();
  EXPECT_EQ(result.outcome, RunOutcome::completed) << result.reason;
  ASSERT_EQ(result.jumps.size(), 3U);
  EXPECT_EQ(result.jumps[1].target.source, core::TargetSource::operator_override);
  EXPECT_NEAR(result.jumps[1].target.distance, 0.30, 1e-6);
  EXPECT_NEAR(result.jumps[1].landing.distance, 0.30, 0.03);
  EXPECT_EQ(result.jumps[2].target.source, core::TargetSource::perception) << "holds for one jump";
}

TEST_F(LockedJump, IsOpenUntilItTakesOffThoughItsPlanIsMade) {
  go_to(1, RobotPhase::landing);
  if (HasFatalFailure()) return;
  planned_ = false;
  while (!planned_) ASSERT_TRUE(step());
  run_for(110);  // until the plan is handed over
  if (HasFatalFailure()) return;
  ASSERT_EQ(phase_, RobotPhase::landing) << "a plan waits for the end of the landing";
  (void)ask(0.30);
  ASSERT_EQ(answers_.size(), 1U);
  ASSERT_TRUE(answers_[0].accepted()) << answers_[0].refusal.sentence;
  const RunResult result = run_to_end();
  ASSERT_EQ(result.jumps.size(), 3U);
  EXPECT_EQ(result.jumps[1].target.source, core::TargetSource::operator_override);
  EXPECT_NEAR(result.jumps[1].target.distance, 0.30, 1e-6);
  EXPECT_EQ(result.jumps[1].outcome, JumpOutcome::landed);
}

TEST_F(LockedJump, RefusesWhatIsNotPlannedBeforeItTakesOff) {
  int take_off = 0;  // tick of the second jump's
  {
    LockstepRun other(request());
    bool crouched = false;
    while (!crouched && other.step([&](const TickRecord& tick) {
      crouched = tick.jump == 2 && tick.status.phase == RobotPhase::crouch;
    })) {
      ++take_off;
    }
    ASSERT_TRUE(crouched);
  }
  run_for(take_off - 50);  // planning takes 100 ms
  if (HasFatalFailure()) return;
  ASSERT_EQ(phase_, RobotPhase::landing);
  EXPECT_LE(ask(0.30), 60);
  ASSERT_EQ(answers_.size(), 1U);
  EXPECT_EQ(answers_[0].refusal.reason, Reason::not_now);
  EXPECT_EQ(phase_, RobotPhase::crouch);
  const RunResult result = run_to_end();
  EXPECT_EQ(result.outcome, RunOutcome::completed) << result.reason;
  for (const JumpResult& jump : result.jumps) {
    EXPECT_EQ(jump.target.source, core::TargetSource::perception) << "jump " << jump.index;
    EXPECT_EQ(jump.outcome, JumpOutcome::landed) << "jump " << jump.index;
  }
}

TEST_F(LockedJump, CanBeWithdrawnByAHoldUntilItRises) {
  go_to(1, RobotPhase::landing);
  if (HasFatalFailure()) return;
  (void)ask(0.30);
  ASSERT_EQ(answers_.size(), 1U);
  ASSERT_TRUE(answers_[0].accepted()) << answers_[0].refusal.sentence;
  while (phase_ != RobotPhase::crouch) ASSERT_TRUE(step());
  core::OperatorCommand hold;
  hold.sequence = ++asked_;
  hold.mode = core::ModeRequest::hold;
  answers_.clear();
  run_.apply(hold);
  run_for(1500);
  if (HasFatalFailure()) return;
  ASSERT_EQ(answers_.size(), 1U);
  EXPECT_TRUE(answers_[0].accepted());
  EXPECT_EQ(phase_, RobotPhase::hold);
  run_.stop();
  int landed = 0;
  for (const JumpResult& jump : run_.result().jumps) {
    landed += jump.outcome == JumpOutcome::landed ? 1 : 0;
  }
  EXPECT_EQ(landed, 1) << "the second was called off";
}

}  // namespace
}  // namespace hopscotch::apps
