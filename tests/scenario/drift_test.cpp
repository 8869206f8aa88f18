// A robot whose believed height is wrong by 30 mm after a landing: what it sees from there on no
// longer fits what it saw before. Either the belief jumps, or the accelerometer is wrong in flight.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "apps/pipeline.hpp"
#include "model/kinematics.hpp"
#include "model/stand_posture.hpp"
#include "sim/judge.hpp"
#include "sim/mujoco_plant.hpp"
#include "sim/sim_camera.hpp"

namespace hopscotch::apps {
namespace {

using core::RobotPhase;

constexpr const char* kCourse =
    "name: steps\n"
    "camera: {width: 320, height: 240}\n"
    "slabs:\n"
    "  - {x_m: [-1.0, 0.175]}\n"
    "  - {x_m: [0.275, 0.65], top_m: 0.05}\n"
    "  - {x_m: [0.75, 1.15], top_m: 0.02}\n"
    "  - {x_m: [1.25, 1.65], top_m: 0.06}\n"
    "  - {x_m: [1.75, 4.0], top_m: 0.03}\n"
    "goal: {x_m: 1.85}\n";

/// Of the seen ground ahead, beside where it is relative to the soles.
struct MapError {
  int cells = 0;
  double median = 0.0;  ///< Of the sizes [m].
  double most = 0.0;    ///< 95 of 100 are smaller [m].
};

/// What goes wrong.
struct DriftFault {
  int landing = 0;     ///< Counted from one.
  double jump = 0.0;   ///< From it on the robot believes to be so much higher [m].
  double force = 0.0;  ///< In the flight before it the accelerometer reads more, upwards [m/s^2].
  [[nodiscard]] bool in_sensor() const { return force != 0.0; }
};

struct DriftRun {
  std::vector<MapError> at_landing;  ///< When the jump after each landing was decided on.
  std::optional<MissionEnd> end;
  std::vector<double> height_error;  ///< Then; of the trunk, believed less true [m].
  double at_touchdown = 0.0;         ///< The same at the touchdown of the faulty flight [m].
  int landings = 0;
  bool fell = false;
};

/// Pipeline and simulated world; what the pipeline is told of its height has a fault.
class DriftingRobot {
 public:
  explicit DriftingRobot(const DriftFault& fault)
      : scenario_(sim::Scenario::from_text(kCourse, "steps")),
        terrain_(scenario_.true_terrain()),
        robot_(model::RobotParameters::load(config() + "robots/hector.yaml")),
        tuning_(ProgramConfig::load(config() + "hopscotch.yaml")),
        plant_(plant_options()),
        camera_(scenario_.camera, robot_, scenario_.seen, 3),
        pipeline_(tuning_, robot_, mission(), {}, Threading::lockstep),
        fault_(fault) {}

  DriftRun run() {
    while (!done_.end && !done_.fell && plant_.now().seconds() < 30.0) step();
    return done_;
  }

 private:
  static std::string config() { return HOPSCOTCH_SOURCE_DIR "/config/"; }
  sim::PlantOptions plant_options() const {
    const auto pose = model::stand_pose(robot_, tuning_.stand_posture);
    return {.scenario = scenario_,
            .robot = robot_,
            .posture = {.q = pose->q, .trunk_pitch = pose->trunk_pitch},
            .variation = {},
            .seed = 3};
  }
  Mission mission() const {
    Mission mission;
    mission.goal_x = *scenario_.goal.x;
    return mission;
  }

  void step() {
    core::SensorReadings readings = plant_.exchange(command_);
    truth_ = plant_.truth();
    camera_.expose(truth_.state);
    const bool in_flight = phase_ == RobotPhase::flight && done_.landings + 1 == fault_.landing;
    if (fault_.in_sensor()) {
      if (in_flight) readings.f_B.z() += fault_.force;
      command_ = pipeline_.tick(readings, camera_);
    } else {
      core::RobotState believed = truth_.state;
      if (done_.landings >= fault_.landing) believed.p_WB.z() += fault_.jump;
      command_ = pipeline_.tick(believed, camera_);
    }
    watch();
  }
  double height_error() const { return pipeline_.state().p_WB.z() - truth_.state.p_WB.z(); }
  void watch() {
    const RobotPhase phase = pipeline_.status().phase;
    const bool touched = phase == RobotPhase::landing && phase_ != RobotPhase::landing;
    if (touched && pipeline_.status().plan_id != 0) {
      ++done_.landings;
      if (done_.landings == fault_.landing) done_.at_touchdown = height_error();
    }
    phase_ = phase;
    const bool decided = pipeline_.events().choice && pipeline_.events().choice->target;
    if (decided && static_cast<int>(done_.at_landing.size()) <= done_.landings) {
      done_.at_landing.push_back(compare(*pipeline_.events().map));
      done_.height_error.push_back(height_error());
    }
    done_.end = pipeline_.end();
    done_.fell = sim::fall_of(truth_).has_value();
  }
  double sole_height(const core::RobotState& state) const {
    const auto soles = model::sole_poses(robot_, state);
    return 0.5 * (soles[0].translation().z() + soles[1].translation().z());
  }
  /// Cells on treads, which begin with the next one: the soles' own is taken from the soles.
  MapError compare(const core::TerrainMap& map) const {
    constexpr double kBesideEdges = 0.03;
    constexpr double kNearest = 0.20;
    constexpr double kFarthest = 0.90;
    constexpr double kHalfWidth = 0.15;
    const Eigen::Vector3d off = pipeline_.state().p_WB - truth_.state.p_WB;
    const double shift = sole_height(pipeline_.state()) - sole_height(truth_.state);
    const double here = truth_.state.p_WB.x();
    std::vector<double> errors;
    for (int iy = 0; iy < map.size_y; ++iy) {
      for (int ix = 0; ix < map.size_x; ++ix) {
        const double x = map.origin_x + (ix + 0.5) * map.resolution - off.x();
        const double y = map.origin_y + (iy + 0.5) * map.resolution - off.y();
        const core::TerrainCell& cell = map.at(ix, iy);
        const bool ahead = x > here + kNearest && x < here + kFarthest && std::abs(y) < kHalfWidth;
        if (!ahead || cell.state != core::CellState::observed) continue;
        const auto top = terrain_.top_at({x, y});
        const auto before = terrain_.top_at({x - kBesideEdges, y});
        const auto beyond = terrain_.top_at({x + kBesideEdges, y});
        if (!top || before != top || beyond != top) continue;
        errors.push_back(std::abs(static_cast<double>(cell.height) - shift - *top));
      }
    }
    if (errors.empty()) return {};
    std::sort(errors.begin(), errors.end());
    return {static_cast<int>(errors.size()), errors[errors.size() / 2],
            errors[errors.size() * 95 / 100]};
  }

  sim::Scenario scenario_;
  sim::Terrain terrain_;
  model::RobotParameters robot_;
  ProgramConfig tuning_;
  sim::MujocoPlant plant_;
  sim::SimCamera camera_;
  Pipeline pipeline_;
  DriftFault fault_;
  core::JointCommand command_;
  sim::PlantTruth truth_;
  RobotPhase phase_ = RobotPhase::stand;
  DriftRun done_;
};

class Drift : public ::testing::TestWithParam<int> {};

TEST_P(Drift, OfALandingIsAbsorbedByTheNextContactAndTheChainGoesOn) {
  constexpr int kLanding = 2;
  const double drift = 1e-3 * GetParam();
  const DriftRun run = DriftingRobot({.landing = kLanding, .jump = drift}).run();
  EXPECT_FALSE(run.fell);
  ASSERT_TRUE(run.end.has_value());
  EXPECT_EQ(*run.end, MissionEnd::reached);
  ASSERT_GE(run.at_landing.size(), 4U);
  EXPECT_NEAR(run.at_landing[kLanding].median, std::abs(drift), 0.005) << "or nothing happened";
  for (std::size_t i = 0; i < run.at_landing.size(); ++i) {
    if (static_cast<int>(i) == kLanding) continue;
    const MapError& error = run.at_landing[i];
    EXPECT_GT(error.cells, 500) << "after landing " << i;
    EXPECT_LT(error.median, 0.005) << "after landing " << i;
    EXPECT_LT(error.most, 0.010) << "after landing " << i;
  }
}

/// The soles that stand then find the speed that the flight ended with wrong, and with it the
/// height.
TEST_P(Drift, OfAFlightWithAWrongAccelerometerIsAbsorbedByItsOwnLanding) {
  constexpr int kLanding = 2;
  constexpr double kForcePerDrift = 0.7 / 0.03;  // [m/s^2/m], in a flight of 0.3 s
  const double drift = 1e-3 * GetParam();
  const DriftRun run = DriftingRobot({.landing = kLanding, .force = kForcePerDrift * drift}).run();
  EXPECT_FALSE(run.fell);
  ASSERT_TRUE(run.end.has_value());
  EXPECT_EQ(*run.end, MissionEnd::reached);
  ASSERT_GT(run.at_landing.size(), 2U);
  const double before = run.height_error[kLanding - 1];
  EXPECT_NEAR(run.at_touchdown - before, drift, 0.010) << "or nothing happened";
  for (std::size_t i = kLanding; i < run.at_landing.size(); ++i) {
    EXPECT_NEAR(run.height_error[i], before, 0.010) << "after landing " << i;
    EXPECT_LT(run.at_landing[i].median, 0.005) << "after landing " << i;
    EXPECT_LT(run.at_landing[i].most, 0.010) << "after landing " << i;
  }
}

INSTANTIATE_TEST_SUITE_P(Millimetres, Drift, ::testing::Values(30, -30), [](const auto& drift) {
  return drift.param > 0 ? std::string("30_up") : std::string("30_down");
});

}  // namespace
}  // namespace hopscotch::apps
