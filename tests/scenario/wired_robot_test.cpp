// The robot's own program on emulated CAN buses and drives, with MuJoCo behind them. Every fault
// has its end state: who is limp, who stands, and how far the trunk came down.
#include <gtest/gtest.h>

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "sim/sim_camera.hpp"
#include "tests/scenario/wired_robot.hpp"

namespace hopscotch::apps {
namespace {

using core::Reason;
using core::RobotPhase;
using testing::WiredRobot;

bool any_drive_on(WiredRobot& robot) {
  for (int joint = 0; joint < core::kJoints; ++joint) {
    if (robot.world.drive(joint).in_motor_mode()) return true;
  }
  return false;
}

TEST(WiredRobot, StandsUpLeapsThreeTimesAndStopsOnCommand) {
  RobotConfig config = testing::wired_config();
  config.session.jumps_per_command = 3;
  WiredRobot robot(config);
  ASSERT_TRUE(robot.stand());
  const double standing = robot.world.truth().state.p_WB.z();
  EXPECT_EQ(robot.session.stage(), SessionStage::active);
  robot.run(1.0);
  EXPECT_EQ(robot.brain.jumps(), 0);  // nothing jumps before it is told to
  robot.ask(core::ModeRequest::jump);
  ASSERT_TRUE(robot.run_until([&] { return robot.brain.jumps() == 3; }, 20.0))
      << core::reason_code(robot.session.fault().reason) << " "
      << hardware::describe(robot.session.fault().plant, robot.world.topology());
  robot.run(4.0);
  EXPECT_EQ(robot.brain.jumps(), 3);  // as many as configured, then it holds
  robot.ask(core::ModeRequest::stop);
  ASSERT_TRUE(robot.run_until([&] { return robot.brain.pipeline().end().has_value(); }, 5.0));
  EXPECT_EQ(*robot.brain.pipeline().end(), MissionEnd::stopped);
  EXPECT_FALSE(robot.fallen);
  EXPECT_NEAR(robot.world.truth().state.p_WB.x(), 0.75, 0.12);  // three times 25 cm
  EXPECT_NEAR(robot.world.truth().state.p_WB.z(), standing, 0.02);
  EXPECT_EQ(robot.plant.counters().lost_replies, 0U);
  robot.session.stop_now();
  EXPECT_TRUE(robot.run_until([&] { return robot.session.stage() == SessionStage::off; }, 5.0));
  robot.run(0.01);
  EXPECT_FALSE(any_drive_on(robot));
}

TEST(WiredRobot, RefusesATargetForTheJumpThatIsUnderWay) {
  WiredRobot robot(testing::wired_config());
  std::vector<core::OperatorAnswer> answers;
  robot.each_tick = [&](const core::RobotState&) {
    if (!robot.brain.ticked()) return;
    for (const auto& answer : robot.brain.pipeline().events().answers) answers.push_back(answer);
  };
  ASSERT_TRUE(robot.stand());
  robot.ask(core::ModeRequest::jump);
  const auto phase = [&] { return robot.brain.pipeline().status().phase; };
  ASSERT_TRUE(robot.run_until([&] { return phase() == RobotPhase::flight; }, 6.0));
  const core::LandingTarget target = robot.brain.pipeline().plan().target;
  answers.clear();
  core::OperatorCommand command;
  command.sequence = 77;
  command.target = core::TargetOverride{.distance = target.distance + 0.10};
  robot.brain.apply(command);
  ASSERT_TRUE(robot.run_until([&] { return !answers.empty(); }, 0.01));
  EXPECT_EQ(answers[0].command.sequence, 77U);
  EXPECT_EQ(answers[0].refusal.reason, Reason::not_now) << answers[0].refusal.sentence;
  EXPECT_EQ(robot.brain.pipeline().plan().target.distance, target.distance);
  ASSERT_TRUE(robot.run_until([&] { return robot.brain.jumps() == 1; }, 2.0));
  robot.run(1.5);
  EXPECT_FALSE(robot.fallen);
  EXPECT_NEAR(robot.world.truth().state.p_WB.x(), target.distance, 0.06);
}

// Planning, MPC and perception on threads of their own, as on a robot. The clock is slowed down, so
// that a busy machine keeps up.
TEST(WiredRobot, LeapsWithItsStagesOnThreads) {
  RobotConfig config = testing::wired_config();
  config.pacing.mode = Pacing::Mode::real_time;
  WiredRobot robot(config);
  robot.wake.emplace(0.003);
  ASSERT_TRUE(robot.stand());
  robot.ask(core::ModeRequest::jump);
  ASSERT_TRUE(robot.run_until([&] { return robot.brain.jumps() == 1; }, 8.0))
      << core::reason_code(robot.session.fault().reason) << " "
      << hardware::describe(robot.session.fault().plant, robot.world.topology());
  robot.run(1.5);
  EXPECT_EQ(robot.session.stage(), SessionStage::active);
  EXPECT_FALSE(robot.fallen);
  EXPECT_NEAR(robot.world.truth().state.p_WB.x(), 0.25, 0.06);
}

/// @param slabs  The ground, as in a scenario file.
RobotConfig config_on(const std::string& slabs) {
  const std::string scenario =
      "name: ground\ncamera: {width: 320, height: 240}\nplant: {latency_ms: 0}\n"
      "goal: {jumps: 1}\nslabs:\n" +
      slabs;
  RobotConfig config = testing::wired_config();
  config.session.has_eyes = true;
  config.emulation.scenario = sim::Scenario::from_text(scenario, "ground");
  return config;
}

/// A robot with the depth camera of its scenario on the trunk.
struct SeeingRobot {
  explicit SeeingRobot(const RobotConfig& config)
      : camera(config.emulation.scenario.camera, config.robot, config.emulation.scenario.seen, 5),
        robot(config, &camera) {
    robot.each_tick = [this](core::RobotState truth) {
      truth.stamp = robot.world.now();  // in the harness the plant's own time stands still
      camera.expose(truth);
    };
  }
  sim::SimCamera camera;
  WiredRobot robot;
};

TEST(WiredRobot, SeesTheStepThatItLeapsOnto) {
  SeeingRobot seeing(
      config_on("  - {x_m: [-1.0, 0.15]}\n"
                "  - {x_m: [0.15, 2.0], top_m: 0.06}\n"));
  WiredRobot& robot = seeing.robot;
  ASSERT_TRUE(robot.stand());
  const double standing = robot.world.truth().state.p_WB.z();
  robot.ask(core::ModeRequest::jump);
  ASSERT_TRUE(robot.run_until([&] { return robot.brain.jumps() == 1; }, 8.0));
  robot.run(2.0);
  EXPECT_EQ(robot.session.stage(), SessionStage::active);
  EXPECT_FALSE(robot.fallen);
  EXPECT_NEAR(robot.world.truth().state.p_WB.z(), standing + 0.06, 0.02);
}

TEST(WiredRobot, HoldsBeforeAPitAndSaysWhy) {
  SeeingRobot seeing(config_on("  - {x_m: [-1.0, 0.12]}\n"));
  WiredRobot& robot = seeing.robot;
  ASSERT_TRUE(robot.stand());
  robot.ask(core::ModeRequest::jump);
  std::optional<core::Refusal> refusal;
  const auto refused = [&] {
    if (!refusal) refusal = robot.brain.take_refusal();
    return refusal.has_value();
  };
  ASSERT_TRUE(robot.run_until(refused, 8.0));
  EXPECT_FALSE(refusal->sentence.empty());
  robot.run(1.0);
  EXPECT_EQ(robot.brain.jumps(), 0);
  EXPECT_EQ(robot.session.stage(), SessionStage::active);
  EXPECT_FALSE(robot.fallen);
  EXPECT_TRUE(robot.brain.pipeline().held());
}

TEST(WiredRobot, HoldsWhenItsEyesGoDark) {
  SeeingRobot seeing(config_on("  - {x_m: [-1.0, 3.0]}\n"));
  WiredRobot& robot = seeing.robot;
  ASSERT_TRUE(robot.stand());
  robot.each_tick = nullptr;  // no frame is exposed any more
  robot.run(2.0);
  robot.ask(core::ModeRequest::jump);
  robot.run(4.0);
  EXPECT_EQ(robot.brain.jumps(), 0);
  const std::optional<core::Refusal> refusal = robot.brain.take_refusal();
  ASSERT_TRUE(refusal.has_value());
  EXPECT_EQ(refusal->reason, Reason::terrain_unseen) << refusal->sentence;
  EXPECT_EQ(robot.session.stage(), SessionStage::active);
  EXPECT_FALSE(robot.fallen);
}

constexpr int kLeftKnee = 3;
constexpr std::size_t kKneeBus = 1;

class WiredFault : public ::testing::Test {
 protected:
  void stand() {
    robot_ = std::make_unique<WiredRobot>(config_);
    ASSERT_TRUE(robot_->stand());
    ASSERT_EQ(robot_->session.fault().reason, Reason::none);
    highest_ = robot_->world.truth().state.p_WB.z();
  }
  void fly() {
    stand();
    robot_->ask(core::ModeRequest::jump);
    ASSERT_TRUE(robot_->run_until([&] { return phase() == RobotPhase::flight; }, 6.0));
    robot_->run(0.05);
    ASSERT_EQ(phase(), RobotPhase::flight);
  }
  [[nodiscard]] RobotPhase phase() const { return robot_->brain.pipeline().status().phase; }

  /// And not just brakes.
  [[nodiscard]] bool holds_posture() const {
    return robot_->session.command().mode == core::DriveMode::active;
  }

  /// The robot notices, comes to rest and lets go: the end of every fault.
  void expect_soft_stop(Reason reason) {
    EXPECT_TRUE(
        robot_->run_until([&] { return robot_->session.stage() == SessionStage::stopping; }, 1.0))
        << "never noticed";
    EXPECT_EQ(robot_->session.fault().reason, reason)
        << hardware::describe(robot_->session.fault().plant, robot_->world.topology());
    EXPECT_TRUE(
        robot_->run_until([&] { return robot_->session.stage() == SessionStage::off; }, 8.0))
        << "never still";
    robot_->run(0.05);
    EXPECT_FALSE(any_drive_on(*robot_));
    EXPECT_FALSE(robot_->session.obstacle().empty());  // latched until the operator clears it
  }
  void expect_standing() {
    EXPECT_EQ(robot_->session.stage(), SessionStage::active);
    EXPECT_EQ(robot_->session.fault().reason, Reason::none);
    EXPECT_FALSE(robot_->fallen);
    EXPECT_NEAR(robot_->world.truth().state.p_WB.z(), highest_, 0.03);
  }

  RobotConfig config_ = testing::wired_config();
  std::unique_ptr<WiredRobot> robot_;
  double highest_ = 0.0;  // of the trunk while standing [m]
};

TEST_F(WiredFault, OneLostReplyIsLivedWith) {
  stand();
  robot_->world.bus(kKneeBus).lose_answers(1);
  robot_->run(0.5);
  EXPECT_EQ(robot_->plant.counters().lost_replies, 1U);
  expect_standing();
}

TEST_F(WiredFault, NoisyWiresLoseRepliesAndTheRobotLeapsAllTheSame) {
  config_.emulation.bus_error_share = 0.002;
  stand();
  robot_->ask(core::ModeRequest::jump);
  EXPECT_TRUE(robot_->run_until([&] { return robot_->brain.jumps() == 1; }, 6.0));
  robot_->run(2.0);
  EXPECT_GT(robot_->plant.counters().lost_replies, 20U);
  expect_standing();
}

TEST_F(WiredFault, ManyLostRepliesEndInASoftStop) {
  stand();
  robot_->world.bus(kKneeBus).lose_answers(20);  // of two drives: ten exchanges
  expect_soft_stop(Reason::drive_silent);
}

TEST_F(WiredFault, SilentDriveEndsInASoftStopOfAllOthers) {
  stand();
  robot_->world.drive(kLeftKnee).defects().silent = true;
  expect_soft_stop(Reason::drive_silent);
  EXPECT_EQ(robot_->session.fault().plant.joint, kLeftKnee);
}

TEST_F(WiredFault, OverTemperatureEndsInASoftStop) {
  stand();
  robot_->world.drive(kLeftKnee).defects().fault = hardware::DriveFault::over_temperature;
  expect_soft_stop(Reason::drive_fault);
  EXPECT_EQ(robot_->session.fault().plant.drive, hardware::DriveFault::over_temperature);
}

TEST_F(WiredFault, SwappedReplyIdentifiersAreFoundBeforeAnyTorque) {
  config_.emulation.faults = {{.kind = ScriptedFault::Kind::swapped_replies, .joint = kLeftKnee}};
  WiredRobot robot(config_);
  robot.session.tick();
  robot.session.tick();
  EXPECT_NE(robot.session.obstacle().find("left_knee has not answered"), std::string::npos)
      << robot.session.obstacle();
  EXPECT_FALSE(any_drive_on(robot));
  EXPECT_GT(robot.plant.counters().wrong_sender, 0U);
}

TEST_F(WiredFault, WrongHomePoseIsRefused) {
  WiredRobot robot(config_);
  config_.homing.pose(3) = -1.2;  // the jig says otherwise
  RobotSession session(config_, robot.plant, landing_posture(config_));
  session.tick();
  session.tick();
  EXPECT_NE(session.obstacle().find("left_knee"), std::string::npos) << session.obstacle();
}

TEST_F(WiredFault, BusOffOnOneBusEndsInASoftStopOnTheOthers) {
  stand();
  robot_->world.bus(kKneeBus).force_bus_off();
  EXPECT_TRUE(
      robot_->run_until([&] { return robot_->session.stage() == SessionStage::stopping; }, 0.01));
  EXPECT_EQ(robot_->session.fault().reason, Reason::bus_fault);
  EXPECT_EQ(robot_->session.fault().plant.bus, static_cast<int>(kKneeBus));
  // What the bus does not reach goes limp by its watchdog; the rest brakes until it is still.
  robot_->run(0.05);
  EXPECT_FALSE(robot_->world.drive(kLeftKnee).in_motor_mode());
  EXPECT_TRUE(robot_->world.drive(0).in_motor_mode());
  robot_->run(5.0);
  EXPECT_EQ(robot_->world.drive(0).setpoint().kp, 0.0);
}

TEST_F(WiredFault, CutBusIsNoticedWithinThreeExchanges) {
  stand();
  robot_->world.bus(kKneeBus).cut();
  EXPECT_TRUE(
      robot_->run_until([&] { return robot_->session.stage() == SessionStage::stopping; }, 0.003));
  EXPECT_EQ(robot_->session.fault().reason, Reason::bus_fault);
}

TEST_F(WiredFault, FullQueueEndsInASoftStopBeforeTorquesGetStale) {
  stand();
  robot_->world.bus(kKneeBus).fill_queue();
  EXPECT_TRUE(
      robot_->run_until([&] { return robot_->session.stage() == SessionStage::stopping; }, 0.002));
  EXPECT_EQ(robot_->session.fault().reason, Reason::bus_fault);
  EXPECT_EQ(robot_->session.fault().plant.trouble, hardware::BusTrouble::not_taken);
  robot_->run(5.0);
  EXPECT_FALSE(any_drive_on(*robot_));
}

TEST_F(WiredFault, StuckEncoderOfAMovingJointEndsInASoftStop) {
  stand();
  robot_->ask(core::ModeRequest::jump);
  ASSERT_TRUE(robot_->run_until([&] { return core::is_pushing_off(phase()); }, 6.0));
  robot_->run(0.1);
  robot_->world.drive(kLeftKnee).defects().encoder_stuck = true;
  expect_soft_stop(Reason::encoder_stuck);
  EXPECT_EQ(robot_->session.fault().plant.joint, kLeftKnee);
}

TEST_F(WiredFault, ImuLossInStanceEndsInASoftStop) {
  stand();
  robot_->world.switch_imu_off();
  expect_soft_stop(Reason::imu_lost);
}

TEST_F(WiredFault, ImuLossInFlightLandsOnItsFeetBeforeItLetsGo) {
  fly();
  robot_->world.switch_imu_off();
  ASSERT_TRUE(
      robot_->run_until([&] { return robot_->session.stage() == SessionStage::stopping; }, 0.02));
  EXPECT_EQ(robot_->session.fault().phase, RobotPhase::flight);
  EXPECT_TRUE(holds_posture());
  ASSERT_TRUE(robot_->run_until([&] { return !holds_posture(); }, 0.9));
  const auto contact = robot_->world.truth().state.contact;
  EXPECT_TRUE(contact[0] || contact[1]);  // the ground, not the time, ended the flight
  EXPECT_FALSE(robot_->fallen);           // nothing but the feet has touched it so far
  EXPECT_TRUE(robot_->run_until([&] { return robot_->session.stage() == SessionStage::off; }, 8.0));
}

TEST_F(WiredFault, SilentDriveInFlightLandsOnItsFeetToo) {
  fly();
  robot_->world.drive(9).defects().silent = true;  // the right ankle
  ASSERT_TRUE(
      robot_->run_until([&] { return robot_->session.stage() == SessionStage::stopping; }, 0.02));
  EXPECT_TRUE(holds_posture());
}

TEST_F(WiredFault, HostThatSleepsFiveMillisecondsEndsInASoftStop) {
  stand();
  robot_->stall_ticks = 5;
  expect_soft_stop(Reason::deadline);
  EXPECT_EQ(robot_->session.deadlines().late, 1U);
  EXPECT_NEAR(robot_->session.deadlines().worst, 0.005, 1e-9);
}

TEST_F(WiredFault, OneLateExchangeIsCountedAndFourInATenthOfASecondAreTooMany) {
  stand();
  robot_->stall_ticks = 2;
  robot_->run(0.2);
  EXPECT_EQ(robot_->session.deadlines().late, 1U);
  expect_standing();
  for (int i = 0; i < 4; ++i) {
    robot_->stall_ticks = 2;
    robot_->run(0.01);
  }
  EXPECT_EQ(robot_->session.fault().reason, Reason::deadline);
}

TEST_F(WiredFault, DrivesOfAKilledProgramGoLimpByThemselves) {
  stand();
  for (int tick = 0; tick < 40; ++tick) robot_->world.advance();  // nobody sends anything
  EXPECT_FALSE(any_drive_on(*robot_));
}

TEST_F(WiredFault, PlannerThatNeverAnswersLeavesTheRobotStanding) {
  config_.tuning.runtime.planning_latency = 60.0;  // [s]
  stand();
  robot_->ask(core::ModeRequest::jump);
  robot_->run(4.0);
  EXPECT_EQ(robot_->brain.jumps(), 0);
  expect_standing();
}

TEST_F(WiredFault, FaultIsClearedByTheOperatorAndTheRobotStandsUpAgain) {
  stand();
  robot_->session.stop_now();
  EXPECT_TRUE(robot_->run_until([&] { return robot_->session.stage() == SessionStage::off; }, 8.0));
  EXPECT_TRUE(robot_->session.clear_fault());
  EXPECT_NE(robot_->session.obstacle(), "");  // it lies on the floor: not home
}

}  // namespace
}  // namespace hopscotch::apps
