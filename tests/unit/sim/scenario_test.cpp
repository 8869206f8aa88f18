#include "sim/scenario.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <ostream>
#include <string>

#include "model/kinematics.hpp"

namespace hopscotch::sim {
namespace {

Scenario parse(const std::string& text) {
  return Scenario::from_text(text, "s.yaml");
}

constexpr const char* kFullFile = R"(name: rising-boxes
robot: hector-sim
friction: 0.7
camera: {noise: none, width: 320, height: 240, rate_Hz: 15, latency_ms: 20, x_m: 0.1, z_m: 0.07,
         pitch_rad: 0.5, lost_pixels: 0.2, lost_frames: 0.1, time_error_ms: -30, pitch_error_rad: 0.02}
slabs:
  - {x_m: [-1.0, 0.30], top_m: 0.0}
  - {x_m: [0.50, 0.95], top_m: 0.05, y_m: [-0.5, 0.7], slope_rad: 0.1, yaw_rad: 0.2, friction: 0.8}
pit_depth_m: 0.4
start: {x_m: 0.1, yaw_rad: 0.05, drop_m: 0.2}
goal: {x_m: 2.0}
surprises:
  - {slab: 1, top_m: 0.03}
  - {push: {phase: takeoff, after_s: 0.2, duration_s: 0.1, impulse_Ns: [4.0, 0.0, 1.0]}}
  - {push: {at_s: 1.5, duration_s: 0.05, impulse_Ns: [0.0, 3.0, 0.0]}}
plant: {robot: hector-d14, mass_scale: 1.05, inertia_scale: 0.9, motor_strength: 0.9, latency_ms: 3.0,
        exchange_Hz: 500, sensor_noise: 0.5}
)";

TEST(Scenario, EveryKeyReachesItsPlace) {
  const Scenario s = parse(kFullFile);
  EXPECT_EQ(s.name, "rising-boxes");
  EXPECT_EQ(s.robot, "hector-sim");
  EXPECT_EQ(s.camera.noise, CameraNoise::none);
  EXPECT_EQ(s.camera.width, 320);
  EXPECT_EQ(s.camera.height, 240);
  EXPECT_DOUBLE_EQ(s.camera.rate, 15.0);
  EXPECT_DOUBLE_EQ(s.camera.latency, 0.02);
  EXPECT_DOUBLE_EQ(s.camera.pitch, 0.5);
  EXPECT_DOUBLE_EQ(s.camera.lost_pixels, 0.2);
  EXPECT_DOUBLE_EQ(s.camera.lost_frames, 0.1);
  EXPECT_DOUBLE_EQ(s.camera.time_error, -0.03);
  EXPECT_DOUBLE_EQ(s.camera.pitch_error, 0.02);
  ASSERT_EQ(s.seen.slabs.size(), 2U);
  EXPECT_TRUE(s.seen.slabs[1].centre.isApprox(Eigen::Vector2d(0.725, 0.1)));
  EXPECT_TRUE(s.seen.slabs[1].half_size.isApprox(Eigen::Vector2d(0.225, 0.6)));
  EXPECT_DOUBLE_EQ(s.seen.slabs[1].slope, 0.1);
  EXPECT_DOUBLE_EQ(s.seen.slabs[1].yaw, 0.2);
  EXPECT_DOUBLE_EQ(s.seen.slabs[0].friction, 0.7);
  EXPECT_DOUBLE_EQ(s.seen.slabs[1].friction, 0.8);
  EXPECT_DOUBLE_EQ(s.seen.pit_depth, 0.4);
  EXPECT_DOUBLE_EQ(s.start.x, 0.1);
  EXPECT_DOUBLE_EQ(s.start.yaw, 0.05);
  EXPECT_DOUBLE_EQ(s.start.drop, 0.2);
  EXPECT_EQ(s.goal.x, 2.0);
  EXPECT_FALSE(s.goal.jumps);
  EXPECT_EQ(s.plant.robot, "hector-d14");
  EXPECT_DOUBLE_EQ(s.plant.mass_scale, 1.05);
  EXPECT_DOUBLE_EQ(s.plant.inertia_scale, 0.9);
  EXPECT_DOUBLE_EQ(s.plant.motor_strength, 0.9);
  EXPECT_EQ(s.plant.latency_ticks, 3);
  EXPECT_EQ(s.plant.exchange_period, 2);
  EXPECT_DOUBLE_EQ(s.plant.sensor_noise, 0.5);
}

TEST(Scenario, SurprisesAreHeightsAndPushes) {
  const Scenario s = parse(kFullFile);
  ASSERT_EQ(s.height_surprises.size(), 1U);
  ASSERT_EQ(s.pushes.size(), 2U);
  EXPECT_EQ(s.pushes[0].phase, core::JumpPhase::takeoff);
  EXPECT_DOUBLE_EQ(s.pushes[0].after, 0.2);
  EXPECT_TRUE(s.pushes[0].impulse.isApprox(Eigen::Vector3d(4.0, 0.0, 1.0)));
  EXPECT_FALSE(s.pushes[1].phase);
  EXPECT_DOUBLE_EQ(s.pushes[1].at, 1.5);
  EXPECT_DOUBLE_EQ(s.pushes[1].duration, 0.05);
}

TEST(Scenario, OnlyTheTrueTerrainHasTheHeightSurprise) {
  const Scenario s = parse(kFullFile);
  EXPECT_DOUBLE_EQ(s.seen.slabs[1].top, 0.05);
  EXPECT_DOUBLE_EQ(s.true_terrain().slabs[1].top, 0.08);
  EXPECT_DOUBLE_EQ(s.true_terrain().slabs[0].top, s.seen.slabs[0].top);
}

TEST(Scenario, NameAndSlabsAreEnough) {
  const Scenario s = parse("name: plain\nslabs: [{x_m: [-1, 5]}]\n");
  EXPECT_EQ(s.robot, "hector");
  EXPECT_DOUBLE_EQ(s.friction, 0.6);
  EXPECT_EQ(s.camera.noise, CameraNoise::d435);
  EXPECT_EQ(s.camera.width, 640);
  EXPECT_EQ(s.camera.height, 480);
  EXPECT_DOUBLE_EQ(s.camera.rate, 30.0);
  EXPECT_DOUBLE_EQ(s.camera.latency, 0.04);
  EXPECT_DOUBLE_EQ(s.camera.x, 0.09);
  EXPECT_DOUBLE_EQ(s.camera.z, 0.08);
  EXPECT_DOUBLE_EQ(s.camera.pitch, 0.6);
  EXPECT_DOUBLE_EQ(s.seen.slabs[0].top, 0.0);
  EXPECT_DOUBLE_EQ(s.seen.slabs[0].half_size.y(), 0.6);
  EXPECT_DOUBLE_EQ(s.seen.pit_depth, 0.5);
  EXPECT_EQ(s.goal.x, 3.0);
  EXPECT_EQ(s.plant.robot, "hector");
  EXPECT_EQ(s.plant.latency_ticks, 2);
  EXPECT_EQ(s.plant.exchange_period, 1);
  EXPECT_DOUBLE_EQ(s.plant.sensor_noise, 1.0);
}

TEST(Scenario, ThePlantIsTheSameRobotUnlessItSaysOtherwise) {
  EXPECT_EQ(parse("name: n\nrobot: hector-sim\nslabs: [{x_m: [-1, 5]}]\n").plant.robot,
            "hector-sim");
}

TEST(Scenario, AGoalMayCountJumpsInEitherSpelling) {
  for (const char* goal : {"goal: {jumps: 5}\n", "jumps: 5\n"}) {
    const Scenario s = parse(std::string("name: n\nslabs: [{x_m: [-1, 5]}]\n") + goal);
    EXPECT_EQ(s.goal.jumps, 5) << goal;
    EXPECT_FALSE(s.goal.x) << goal;
  }
}

struct BrokenFile {
  std::string title;
  std::string text;
  std::string message;

  friend void PrintTo(const BrokenFile& file, std::ostream* out) { *out << file.title; }
};

class BrokenScenario : public testing::TestWithParam<BrokenFile> {};

TEST_P(BrokenScenario, IsRefusedWithLineAndRule) {
  try {
    static_cast<void>(parse(GetParam().text));
    FAIL() << "was accepted";
  } catch (const core::ConfigError& error) {
    EXPECT_EQ(std::string(error.what()), GetParam().message);
  }
}

std::string flat(const std::string& more) {
  return "name: n\nslabs:\n  - {x_m: [-1, 5]}\n" + more;
}

INSTANTIATE_TEST_SUITE_P(
    Rules, BrokenScenario,
    testing::Values(
        BrokenFile{"no_name", "slabs: [{x_m: [-1, 1]}]\n", "s.yaml:1: name is missing"},
        BrokenFile{"no_slabs", "name: n\n", "s.yaml:1: slabs is missing"},
        BrokenFile{"empty_slabs", "name: n\nslabs: []\n",
                   "s.yaml:2: slabs = [], but must have at least one slab"},
        BrokenFile{"unknown_key", flat("gaol: {x_m: 3}\n"),
                   "s.yaml:4: gaol is not a known key here"},
        BrokenFile{"unknown_slab_key", "name: n\nslabs:\n  - {x_m: [-1, 1], height_m: 1}\n",
                   "s.yaml:3: slabs[0].height_m is not a known key here"},
        BrokenFile{"wrong_type", flat("friction: slippery\n"),
                   "s.yaml:4: friction = slippery, but must be a number"},
        BrokenFile{"not_finite", flat("friction: .nan\n"),
                   "s.yaml:4: friction = .nan, but must be finite"},
        BrokenFile{"friction_range", flat("friction: 0\n"),
                   "s.yaml:4: friction = 0, but must satisfy 0 < x <= 2"},
        BrokenFile{"unknown_robot", flat("robot: hectopod\n"),
                   "s.yaml:4: robot = hectopod, but must be one of hector, hector-d14, "
                   "hector-urdf, hector-sim"},
        BrokenFile{"slab_backwards", "name: n\nslabs:\n  - {x_m: [1, -1]}\n",
                   "s.yaml:3: slabs[0].x_m = [1, -1], but must rise by at least 0.02 m from its "
                   "first to its second number"},
        BrokenFile{"slab_three_numbers", "name: n\nslabs:\n  - {x_m: [-1, 0, 1]}\n",
                   "s.yaml:3: slabs[0].x_m = [-1, 0, 1], but must be a list of 2 numbers"},
        BrokenFile{"overlap",
                   "name: n\nslabs:\n  - {x_m: [-1, 1]}\n  - {x_m: [0.9, 2], top_m: 0.1}\n",
                   "s.yaml:4: slabs[1].x_m = [0.9, 2], but must not overlap slab 0"},
        BrokenFile{"overlap_by_yaw",
                   "name: n\nslabs:\n  - {x_m: [-1, 1]}\n  - {x_m: [1.05, 2], yaw_rad: 0.5}\n",
                   "s.yaml:4: slabs[1].x_m = [1.05, 2], but must not overlap slab 0"},
        BrokenFile{"below_pit", flat("  - {x_m: [6, 7], top_m: -0.6}\n"),
                   "s.yaml:4: slabs[1].top_m = -0.6, but must keep the slab's whole top above the "
                   "pit floor (pit_depth_m)"},
        BrokenFile{"far_edge_below_pit", flat("  - {x_m: [6, 9], slope_rad: -0.3}\n"),
                   "s.yaml:4: slabs[1].top_m must keep the slab's whole top above the pit floor "
                   "(pit_depth_m)"},
        BrokenFile{"surprise_below_pit",
                   flat("pit_depth_m: 0.02\nsurprises:\n  - {slab: 0, top_m: -0.02}\n"),
                   "s.yaml:6: surprises[0].top_m = -0.02, but must keep the slab's whole top above "
                   "the pit floor (pit_depth_m)"},
        BrokenFile{"start_over_pit", flat("start: {x_m: 5.5}\n"),
                   "s.yaml:4: start = {x_m: 5.5}, but must lie on a slab, not over the pit"},
        BrokenFile{"start_over_pit_by_default", "name: n\nslabs: [{x_m: [1, 2]}]\n",
                   "s.yaml:1: start must lie on a slab, not over the pit"},
        BrokenFile{"toes_over_edge", flat("start: {x_m: 4.95}\n"),
                   "s.yaml:4: start = {x_m: 4.95}, but must put both soles wholly on slab 0"},
        BrokenFile{"one_foot_beside", "name: n\nslabs: [{x_m: [-1, 1], y_m: [-0.09, 0.5]}]\n",
                   "s.yaml:1: start must put both soles wholly on slab 0"},
        BrokenFile{"negative_drop", flat("start: {drop_m: -0.1}\n"),
                   "s.yaml:4: start.drop_m = -0.1, but must satisfy 0 <= x <= 2"},
        BrokenFile{"two_goals", flat("goal: {x_m: 3, jumps: 2}\n"),
                   "s.yaml:4: goal.jumps = 2, but must not stand beside x_m"},
        BrokenFile{"goal_and_jumps", flat("goal: {x_m: 3}\njumps: 2\n"),
                   "s.yaml:5: jumps = 2, but must not stand beside goal"},
        BrokenFile{"no_jumps", flat("goal: {jumps: 0}\n"),
                   "s.yaml:4: goal.jumps = 0, but must satisfy 1 <= x <= 1000000"},
        BrokenFile{"surprise_beyond", flat("surprises:\n  - {slab: 1, top_m: 0.02}\n"),
                   "s.yaml:5: surprises[0].slab = 1, but must satisfy 0 <= x <= 0"},
        BrokenFile{"surprise_twice",
                   flat("surprises:\n  - {slab: 0, top_m: 0.02}\n  - {slab: 0, top_m: 0.01}\n"),
                   "s.yaml:6: surprises[1].slab = 0, but must not be surprised twice"},
        BrokenFile{"surprise_without_height", flat("surprises:\n  - {slab: 0}\n"),
                   "s.yaml:5: surprises[0].top_m is missing"},
        BrokenFile{"push_in_no_phase",
                   flat("surprises:\n  - {push: {phase: dance, impulse_Ns: [1, 0, 0]}}\n"),
                   "s.yaml:5: surprises[0].push.phase = dance, but must be one of takeoff, flight, "
                   "landing"},
        BrokenFile{"push_without_time", flat("surprises:\n  - {push: {impulse_Ns: [1, 0, 0]}}\n"),
                   "s.yaml:5: surprises[0].push.phase is missing"},
        BrokenFile{
            "push_two_times",
            flat("surprises:\n  - {push: {phase: flight, at_s: 1, impulse_Ns: [1, 0, 0]}}\n"),
            "s.yaml:5: surprises[0].push.at_s = 1, but must not stand beside phase"},
        BrokenFile{"push_after_absolute_time",
                   flat("surprises:\n  - {push: {at_s: 1, after_s: 1, impulse_Ns: [1, 0, 0]}}\n"),
                   "s.yaml:5: surprises[0].push.after_s is not a known key here"},
        BrokenFile{"push_in_the_plane",
                   flat("surprises:\n  - {push: {at_s: 1, impulse_Ns: [1, 0]}}\n"),
                   "s.yaml:5: surprises[0].push.impulse_Ns = [1, 0], but must be a list of 3 "
                   "numbers"},
        BrokenFile{"latency_between_ticks", flat("plant: {latency_ms: 1.5}\n"),
                   "s.yaml:4: plant.latency_ms = 1.5, but must be a whole number of ticks of 1 ms"},
        BrokenFile{"exchange_rate", flat("plant: {exchange_Hz: 400}\n"),
                   "s.yaml:4: plant.exchange_Hz = 400, but must be one of 1000, 500"},
        BrokenFile{"no_motor", flat("plant: {motor_strength: 0}\n"),
                   "s.yaml:4: plant.motor_strength = 0, but must satisfy 0 < x <= 2"},
        BrokenFile{"camera_noise", flat("camera: {noise: some}\n"),
                   "s.yaml:4: camera.noise = some, but must be one of none, d435"},
        BrokenFile{"camera_size", flat("camera: {width: 640.5}\n"),
                   "s.yaml:4: camera.width = 640.5, but must be a whole number"},
        BrokenFile{"camera_is_no_mapping", flat("camera: d435\n"),
                   "s.yaml:4: camera = d435, but must be a mapping"}),
    [](const testing::TestParamInfo<BrokenFile>& broken) { return broken.param.title; });

TEST(Scenario, AMissingFileIsNamed) {
  EXPECT_THAT([] { static_cast<void>(Scenario::load("no-such-folder/none.yaml")); },
              testing::ThrowsMessage<core::ConfigError>("no-such-folder/none.yaml: no such file"));
}

TEST(Scenario, TargetsOfTheFirstJumpsAreRead) {
  const Scenario s = parse(
      "name: turn\nslabs:\n  - {x_m: [-1, 2]}\ntargets:\n"
      "  - {distance_m: 0.3, lateral_m: -0.1, yaw_rad: 0.2}\n  - {distance_m: 0.4, height_m: "
      "0.0}\n");
  ASSERT_EQ(s.targets.size(), 2U);
  EXPECT_DOUBLE_EQ(s.targets[0].distance, 0.3);
  EXPECT_DOUBLE_EQ(s.targets[0].lateral, -0.1);
  EXPECT_DOUBLE_EQ(s.targets[0].yaw, 0.2);
  EXPECT_TRUE(std::isnan(s.targets[0].height));
  EXPECT_DOUBLE_EQ(s.targets[1].height, 0.0);
}

TEST(Scenario, EveryFileThatWeShipIsValid) {
  int files = 0;
  const std::filesystem::path folder =
      std::filesystem::path(HOPSCOTCH_SOURCE_DIR) / "config" / "scenarios";
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    const Scenario scenario = Scenario::load(entry.path());
    EXPECT_EQ(scenario.name, entry.path().stem().string());
    ++files;
  }
  EXPECT_GE(files, 6);
}

// The start rule of the scenario file must mean the soles of every robot there is.
TEST(Scenario, StanceOutlineIsThatOfTheRobots) {
  constexpr double kAgreement = 0.0015;  // [m]; hector-d14 is 1 mm narrower
  for (const char* name : {"hector", "hector-d14", "hector-urdf", "hector-sim"}) {
    const model::RobotParameters robot = model::RobotParameters::load(
        std::string(HOPSCOTCH_SOURCE_DIR) + "/config/robots/" + name + ".yaml");
    const core::LegVector straight = core::LegVector::Zero();
    const double spacing =
        model::leg_poses(robot, core::Leg::left, straight).X_BF.translation().y();
    EXPECT_NEAR(StanceOutline::kHalfLength, 0.5 * (robot.toe + robot.heel), kAgreement) << name;
    EXPECT_NEAR(StanceOutline::kHalfSpacing, spacing, kAgreement) << name;
    EXPECT_NEAR(StanceOutline::kHalfWidth, 0.5 * robot.foot_width, kAgreement) << name;
  }
}

}  // namespace
}  // namespace hopscotch::sim
