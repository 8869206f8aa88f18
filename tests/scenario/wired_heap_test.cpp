// What the loop of the robot's own program takes from the heap.
#include <gtest/gtest.h>
#include <sys/mman.h>
#include <unistd.h>

#include <functional>
#include <optional>
#include <string>

#include "apps/robot_voice.hpp"
#include "sim/sim_camera.hpp"
#include "tests/scenario/own_network.hpp"
#include "tests/scenario/wired_robot.hpp"

namespace hopscotch::apps {
namespace {

using testing::WiredRobot;

/// Exchange, session, controller, status over LCM, lines and tables for people, with the stages on
/// threads: memory is taken when the controller starts and on the operator's word, never between.
class WiredHeap : public ::testing::Test {
 protected:
  /// @param camera Null: the floor is level.
  void start(core::DepthSource* camera) {
    robot_.emplace(config_, camera);
    robot_->wake.emplace(0.002);
    robot_->each_tick = [this](const core::RobotState& truth) {
      const std::size_t before = core::allocation_count();
      voice_.tell(robot_->world.now(), robot_->session, &robot_->brain);
      voice_.tell_joints(robot_->world.now(), robot_->session, robot_->plant);
      const std::size_t taken = core::allocation_count() - before + robot_->allocations;
      if (afterwards_) afterwards_(truth);
      if (!watched_) return;
      ++exchanges_;
      EXPECT_EQ(taken, 0U) << "at " << robot_->world.now().seconds() << " s";
    };
    robot_->enable();
    ASSERT_TRUE(robot_->run_until([&] { return robot_->brain.ticked(); }, 3.0));
    watched_ = true;
  }
  void leap() {
    watched_ = false;
    robot_->ask(core::ModeRequest::jump);
    robot_->tick();  // carries the answer away
    watched_ = true;
    ASSERT_TRUE(robot_->run_until([&] { return robot_->brain.jumps() == 1; }, 8.0));
  }
  /// Everything that has been said to people.
  std::string said() {
    console_.reset();
    std::string text(1U << 20U, ' ');
    text.resize(static_cast<std::size_t>(pread(paper_, text.data(), text.size(), 0)));
    return text;
  }
  ~WiredHeap() override { close(paper_); }

  static RobotConfig configured() {
    use_own_network();  // threads inherit it
    RobotConfig config = testing::wired_config();
    config.pacing.mode = Pacing::Mode::real_time;
    return config;
  }
  RobotConfig config_ = configured();
  CommandBox box_;
  LiveRun live_{"udpm://239.255.76.67:7667?ttl=0", box_, 1};
  int paper_ = memfd_create("console", 0);
  std::optional<Console> console_{std::in_place, paper_};
  RobotVoice voice_{config_, *console_, live_};
  std::optional<WiredRobot> robot_;
  std::function<void(const core::RobotState& truth)> afterwards_;
  int exchanges_ = 0;
  bool watched_ = false;
};

TEST_F(WiredHeap, TheLoopTakesNothingFromIt) {
  start(nullptr);
  robot_->run(2.0);
  leap();
  robot_->run(1.0);
  EXPECT_GT(exchanges_, 3000);
  EXPECT_GT(live_.counts().sent, 60U);  // twenty a second
  const std::string text = said();
  EXPECT_NE(text.find("jump 1 has landed"), std::string::npos) << text;
  EXPECT_NE(text.find("left_knee"), std::string::npos) << text;
  EXPECT_NE(text.find("the robot is active, not off"), std::string::npos) << text;
}

TEST_F(WiredHeap, AFaultTakesNothingFromIt) {
  start(nullptr);
  robot_->run(0.5);
  robot_->world.drive(3).defects().silent = true;
  ASSERT_TRUE(robot_->run_until([&] { return robot_->session.stage() == SessionStage::off; }, 8.0));
  robot_->run(1.0);
  const std::string text = said();
  EXPECT_NE(text.find("stopping, fault drive_silent: left_knee (drive "), std::string::npos)
      << text;
  EXPECT_NE(text.find("does not answer, in hold"), std::string::npos) << text;
  EXPECT_NE(text.find("fault drive_silent is latched"), std::string::npos) << text;
}

/// What drawing a frame takes is not the robot's.
class ApartCamera final : public core::DepthSource {
 public:
  ApartCamera(core::DepthSource& camera, std::optional<WiredRobot>& robot)
      : camera_(camera), robot_(robot) {}
  std::optional<core::DepthFrame> poll(core::Stamp now) override {
    std::optional<core::DepthFrame> frame = robot_->apart([&] { return camera_.poll(now); });
    frames += frame ? 1 : 0;
    return frame;
  }
  int frames = 0;

 private:
  core::DepthSource& camera_;
  std::optional<WiredRobot>& robot_;
};

TEST_F(WiredHeap, SeeingTakesNothingFromIt) {
  config_.session.has_eyes = true;
  config_.emulation.scenario = sim::Scenario::from_text(
      "name: ground\ncamera: {width: 320, height: 240}\nplant: {latency_ms: 0}\n"
      "goal: {jumps: 1}\nslabs:\n  - {x_m: [-1.0, 3.0]}\n",
      "ground");
  sim::SimCamera camera(config_.emulation.scenario.camera, config_.robot,
                        config_.emulation.scenario.seen, 5);
  ApartCamera eyes(camera, robot_);
  afterwards_ = [&](core::RobotState truth) {
    truth.stamp = robot_->world.now();  // in the harness the plant's own time stands still
    camera.expose(truth);
  };
  start(&eyes);
  robot_->run(2.0);
  leap();
  robot_->run(1.0);
  EXPECT_GT(eyes.frames, 60);  // thirty a second
  EXPECT_GT(exchanges_, 3000);
}

}  // namespace
}  // namespace hopscotch::apps
