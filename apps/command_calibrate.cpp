#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "apps/calibration_log.hpp"
#include "apps/commands.hpp"
#include "apps/installation.hpp"
#include "apps/program_config.hpp"

namespace hopscotch::apps {

namespace {

using perception::Fitted;

constexpr double kDegrees = 57.29577951308232;  // in a radian

struct CalibrateOptions {
  std::filesystem::path log;
  std::filesystem::path config = config_directory() / "hopscotch.yaml";
  std::string robot = "hector";
  bool json = false;
};

/// Pitch of the optical axis below the trunk's x axis.
double camera_pitch(const Eigen::Isometry3d& X_BC) {
  const Eigen::Vector3d axis = X_BC.linear().col(2);
  return std::atan2(-axis.z(), axis.x());
}

/// Roll about the optical axis: of the image's x axis against the trunk's -y.
double camera_roll(const Eigen::Isometry3d& X_BC) {
  const Eigen::Vector3d right = X_BC.linear().col(0);
  return std::asin(std::max(-1.0, std::min(1.0, -right.z())));
}

nlohmann::ordered_json json_of(const perception::CameraCalibration& result) {
  const Eigen::Vector3d& p = result.X_BC.translation();
  nlohmann::ordered_json json;
  json["schema"] = "hopscotch.calibration/1";
  json["status"] = "determined";
  json["camera"] = {{"x_m", p.x()},
                    {"y_m", p.y()},
                    {"z_m", p.z()},
                    {"roll_rad", camera_roll(result.X_BC)},
                    {"pitch_rad", camera_pitch(result.X_BC)}};
  json["time_offset_s"] = result.time_offset;
  json["sigma"] = {{"x_m", result.sigma(Fitted::x)},
                   {"z_m", result.sigma(Fitted::z)},
                   {"roll_rad", result.sigma(Fitted::roll)},
                   {"pitch_rad", result.sigma(Fitted::pitch)},
                   {"time_offset_s", result.sigma(Fitted::time)}};
  json["covariance"]["order"] = {"x_m", "z_m", "roll_rad", "pitch_rad", "time_offset_s"};
  for (int row = 0; row < perception::kFitted; ++row) {
    const Eigen::Vector<double, perception::kFitted> values = result.covariance.row(row);
    json["covariance"]["matrix"].push_back(
        std::vector<double>(values.data(), values.data() + values.size()));
  }
  json["kept"] = {"y_m", "yaw_rad"};
  json["residual_m"] = result.residual;
  json["points"] = result.points;
  json["frames"] = result.frames;
  return json;
}

void print_people(const perception::CameraCalibration& result) {
  const Eigen::Vector3d& p = result.X_BC.translation();
  std::printf("camera on the trunk, from %d points of ground in %d frames (rms %.1f mm):\n",
              result.points, result.frames, 1e3 * result.residual);
  std::printf("  x      %8.4f m    +- %.2f mm\n", p.x(), 1e3 * result.sigma(Fitted::x));
  std::printf("  z      %8.4f m    +- %.2f mm\n", p.z(), 1e3 * result.sigma(Fitted::z));
  std::printf("  roll   %8.4f rad  +- %.3f deg\n", camera_roll(result.X_BC),
              kDegrees * result.sigma(Fitted::roll));
  std::printf("  pitch  %8.4f rad  +- %.3f deg\n", camera_pitch(result.X_BC),
              kDegrees * result.sigma(Fitted::pitch));
  std::printf("  stamps %+8.4f s    +- %.2f ms (to be added)\n", result.time_offset,
              1e3 * result.sigma(Fitted::time));
  std::printf("y and yaw were kept: one floor does not tell them\n");
}

ExitStatus calibrate(const CalibrateOptions& options) {
  const ProgramConfig config = ProgramConfig::load(options.config);
  const model::RobotParameters robot = model::RobotParameters::load(robot_file(options.robot));
  const auto result = perception::calibrate_camera(
      config.perception.calibration, read_calibration_log(options.log, config.perception, robot));
  if (!result) {
    std::fprintf(stderr, "hopscotch: no calibration: %s\n", result.error().sentence.c_str());
    if (options.json) {
      nlohmann::ordered_json json;
      json["schema"] = "hopscotch.calibration/1";
      json["status"] = "refused";
      json["reason"] = result.error().sentence;
      std::printf("%s\n", json.dump(2).c_str());
    }
    return ExitStatus::answer_is_no;
  }
  if (options.json) {
    std::printf("%s\n", json_of(*result).dump(2).c_str());
  } else {
    print_people(*result);
  }
  return ExitStatus::ok;
}

}  // namespace

void add_calibrate_command(CLI::App& app, Action& action) {
  CLI::App* command =
      app.add_subcommand("calibrate", "Camera pose on the trunk and time offset from a log");
  command->footer(
      "The log must be recorded with `run --log-depth`; a jump moves the trunk enough. A log that\n"
      "does not determine every number is refused with exit status 1.\n"
      "Example: hopscotch calibrate runs/flat-leaps-1/run.lcm");
  const auto options = std::make_shared<CalibrateOptions>();  // shared with the action below
  command->add_option("LOG", options->log, "LCM log with depth")->required();
  command->add_option("--robot", options->robot, "Robot that recorded the log")
      ->capture_default_str();
  command->add_option("--config", options->config, "Tuning")->capture_default_str();
  command->add_flag("--json", options->json, "Print one JSON object");
  command->callback([&action, options] { action = [options] { return calibrate(*options); }; });
}

}  // namespace hopscotch::apps
