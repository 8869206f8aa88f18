#include "apps/calibration_log.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include "apps/installation.hpp"
#include "apps/lockstep_run.hpp"
#include "apps/run_recorder.hpp"
#include "core/config_reader.hpp"

/// Runs are recorded by cameras that sit and tick otherwise than the robot believes, and the
/// recordings are asked how.
namespace hopscotch::apps {
namespace {

namespace fs = std::filesystem;
using perception::Fitted;

ProgramConfig tuning() {
  return ProgramConfig::load(config_directory() / "hopscotch.yaml");
}

model::RobotParameters hector() {
  return model::RobotParameters::load(robot_file("hector"));
}

std::string level_jumps(double time_error_ms, double pitch_error, int jumps) {
  return "name: calibrated\ncamera: {width: 320, height: 240, time_error_ms: " +
         std::to_string(time_error_ms) + ", pitch_error_rad: " + std::to_string(pitch_error) +
         "}\nslabs: [{x_m: [-1.0, 4.0]}]\ngoal: {jumps: " + std::to_string(jumps) + "}\n";
}

/// A folder that is gone afterwards; ctest runs each test in a process of its own, side by side.
class Folder {
 public:
  Folder()
      : path_(fs::path(::testing::TempDir()) /
              ("calibration_log_test-" + std::to_string(getpid()))) {
    fs::remove_all(path_);
  }
  ~Folder() { fs::remove_all(path_); }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  [[nodiscard]] fs::path log() const { return path_ / "run.lcm"; }

  /// Ends early when `stop_after` [s] is over.
  void record(const std::string& scenario, std::uint64_t seed, double stop_after) const {
    RunRequest request;
    request.scenario = sim::Scenario::from_text(scenario, "calibrated");
    request.config = tuning();
    request.robot = hector();
    request.plant_robot = hector();
    request.seed = seed;
    request.log_depth = true;
    RunRecorder recorder(path_, seed, request, {scenario, "", ""});
    LockstepRun run(request);
    while (run.step([&](const TickRecord& tick) { recorder.record(tick); })) {
      if (run.now().seconds() > stop_after) run.stop();
    }
    (void)recorder.finish(run.result());
  }

 private:
  fs::path path_;
};

constexpr double kWholeRun = 60.0;  // [s]

/// Rotation from the believed mounting to the one that was found, in B.
Eigen::Vector3d turn(const Eigen::Isometry3d& believed, const Eigen::Isometry3d& found) {
  const Eigen::AngleAxisd turned(found.linear() * believed.linear().transpose());
  return turned.angle() * turned.axis();
}

TEST(CalibrationLog, TellsHowTheCameraReallySitsAndTicks) {
  constexpr double kTimeErrorMs = 12.0;
  constexpr double kPitchError = 0.010;
  const Folder folder;
  folder.record(level_jumps(kTimeErrorMs, kPitchError, 4), 11, kWholeRun);
  const ProgramConfig config = tuning();
  const perception::CalibrationData data =
      read_calibration_log(folder.log(), config.perception, hector());
  // Five beliefs about the mounting of the one camera that made the log.
  const std::array<Eigen::Vector3d, 5> kShifts{{{0.0, 0.0, 0.0},
                                                {0.01, 0.0, 0.0},
                                                {-0.01, 0.0, 0.005},
                                                {0.0, 0.0, -0.01},
                                                {0.008, 0.0, 0.008}}};
  for (const Eigen::Vector3d& shift : kShifts) {
    perception::CalibrationData believed = data;
    believed.X_BC.translation() += shift;
    const auto found = calibrate_camera(config.perception.calibration, believed);
    ASSERT_TRUE(found) << found.error().sentence;
    const Eigen::Vector3d error = found->X_BC.translation() - data.X_BC.translation();
    EXPECT_LE(std::abs(error.x()), 0.002) << shift.transpose();
    EXPECT_LE(std::abs(error.z()), 0.002) << shift.transpose();
    constexpr double kAngle = 0.0035;  // 0.2 degrees
    const Eigen::Vector3d turned = turn(data.X_BC, found->X_BC);
    EXPECT_NEAR(turned.y(), kPitchError, kAngle) << shift.transpose();
    EXPECT_NEAR(turned.x(), 0.0, kAngle) << shift.transpose();
    EXPECT_NEAR(found->time_offset, -1e-3 * kTimeErrorMs, 0.003) << shift.transpose();
    EXPECT_LE(found->sigma(Fitted::x), 0.002);
  }
}

TEST(CalibrationLog, OfARobotThatStandsStillIsRefused) {
  const Folder folder;
  folder.record(level_jumps(0.0, 0.0, 4), 12, 0.45);  // before the first jump
  const ProgramConfig config = tuning();
  const auto found =
      calibrate_camera(config.perception.calibration,
                       read_calibration_log(folder.log(), config.perception, hector()));
  ASSERT_FALSE(found);
  EXPECT_FALSE(found.error().sentence.empty());
}

TEST(CalibrationLog, CutDamagedForeignOrDepthlessLogsAreErrors) {
  const Folder folder;
  folder.record(level_jumps(0.0, 0.0, 4), 13, 0.2);
  std::ostringstream content;
  content << std::ifstream(folder.log(), std::ios::binary).rdbuf();
  const std::string whole = content.str();
  const auto message_of = [&](const std::string& bytes) -> std::string {
    std::ofstream(folder.log(), std::ios::binary) << bytes;
    try {
      (void)read_calibration_log(folder.log(), tuning().perception, hector());
    } catch (const core::ConfigError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(message_of(whole), "");
  EXPECT_NE(message_of(whole.substr(0, whole.size() - 100)).find("cut short"), std::string::npos);
  EXPECT_NE(message_of("no log at all").find("no LCM log"), std::string::npos);
  EXPECT_NE(message_of(""), "");
  EXPECT_THROW((void)read_calibration_log("nowhere.lcm", tuning().perception, hector()),
               core::ConfigError);
}

}  // namespace
}  // namespace hopscotch::apps
