#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "apps/command_depth.hpp"
#include "apps/commands.hpp"
#include "apps/installation.hpp"
#include "apps/option_check.hpp"
#include "apps/scene_pictures.hpp"
#include "apps/scene_terrain.hpp"
#include "apps/text_file.hpp"
#include "core/config_reader.hpp"

namespace hopscotch::apps {

namespace {

struct SceneOptions {
  std::filesystem::path file;
  std::filesystem::path config = config_directory() / "hopscotch.yaml";
  std::filesystem::path out;
  DepthOptions depth;
  std::vector<double> origin;
  std::optional<double> camera_height;
  std::optional<double> camera_pitch;
  std::string up;
  std::string forward;
  bool json = false;
};

const std::map<std::string, Eigen::Vector3d>& axes() {
  static const std::map<std::string, Eigen::Vector3d> kAxes{
      {"x", Eigen::Vector3d::UnitX()}, {"-x", -Eigen::Vector3d::UnitX()},
      {"y", Eigen::Vector3d::UnitY()}, {"-y", -Eigen::Vector3d::UnitY()},
      {"z", Eigen::Vector3d::UnitZ()}, {"-z", -Eigen::Vector3d::UnitZ()}};
  return kAxes;
}

SceneRequest request_of(const SceneOptions& options) {
  SceneRequest request;
  request.file = options.file;
  request.scaling = options.depth.scaling();
  perception::GroundHints& hints = request.hints;
  if (!options.up.empty()) hints.up = axes().at(options.up);
  if (!options.forward.empty()) hints.forward = axes().at(options.forward);
  hints.camera_height = options.camera_height;
  hints.camera_pitch = options.camera_pitch;
  if (!options.origin.empty()) hints.origin = {options.origin[0], options.origin[1]};
  if (hints.up && hints.forward && std::abs(hints.up->dot(*hints.forward)) > 0.5) {
    throw core::ConfigError("--forward " + options.forward + " must not be along --up " +
                            options.up);
  }
  if (hints.up && hints.camera_pitch) {
    throw core::ConfigError("--up and --camera-pitch both state which way is up; give one");
  }
  return request;
}

void say(const SceneOptions& options, const SceneTerrain& scene) {
  const TerrainReport& report = scene.report;
  std::printf("%s: %s\n", options.file.c_str(), report.status.c_str());
  if (const perception::SurveyedTread* ground = report.survey.ground()) {
    std::printf("ground: height %.3f m, slope %.1f deg, roughness %.1f mm; coverage %.0f %%\n",
                report.terrain.p_WS.z() + ground->height, 57.29578 * ground->slope,
                1e3 * ground->roughness, 100.0 * report.terrain.coverage);
  }
  static constexpr std::array<const char*, 4> kKinds{"up", "down", "gap from here", "gap to here"};
  const core::OneStepTerrain& features = report.survey.features;
  for (std::size_t i = 0; i < features.edge_count; ++i) {
    const core::TerrainEdge& edge = features.edges[i];
    std::printf("  edge %.3f m ahead (+-%.0f mm): %s", edge.x, 1e3 * edge.sigma,
                kKinds[static_cast<std::size_t>(edge.kind)]);
    std::isfinite(edge.step) ? std::printf(", step %+.3f m\n", edge.step)
                             : std::printf(", nothing is seen behind it\n");
  }
  for (const ReportedPlane& plane : report.planes) {
    std::printf("  plane at %+.3f m, slope %.1f deg, %d points\n", plane.height,
                57.29578 * plane.slope, plane.points);
  }
  if (report.choice.target) {
    std::printf("target: %.3f m ahead, %+.3f m, safe with %.4f; %zu places would do\n",
                report.choice.target->distance, report.choice.target->height,
                report.choice.target->safe_probability, report.choice.ranked_count);
  } else {
    std::printf("no target: %s\n", report.choice.refusal.text().c_str());
  }
}

void write_pictures(const SceneOptions& options, const SceneRecording& recording,
                    const SceneTerrain& scene) {
  std::filesystem::create_directories(options.out);
  draw_map(options.out / "map.png", scene.map, scene.report);
  if (recording.frame) {
    draw_over_depth(options.out / "depth.png", *recording.frame, scene.X_WR, scene.report);
  }
  write_file_atomically(options.out / "terrain.json", terrain_json(scene.report) + "\n");
}

ExitStatus scene(const SceneOptions& options) {
  const SceneRequest request = request_of(options);
  const ProgramConfig config = ProgramConfig::load(options.config);
  const model::RobotParameters robot = model::RobotParameters::load(robot_file("hector"));
  const SceneRecording recording = read_scene(request, config);
  if (recording.frame && !request.scaling.intrinsics) {
    const core::CameraIntrinsics& lens = recording.frame->intrinsics;
    std::fprintf(stderr, "hopscotch: no --intrinsics: taken as %g,%g,%g,%g for %dx%d pixels\n",
                 lens.fx, lens.fy, lens.cx, lens.cy, lens.width, lens.height);
  }
  const SceneTerrain terrain = look_at_scene(request, recording, config, robot);
  if (!options.out.empty()) write_pictures(options, recording, terrain);
  if (options.json) {
    std::printf("%s\n", terrain_json(terrain.report).c_str());
  } else {
    say(options, terrain);
  }
  return ExitStatus::ok;
}

void add_pose_options(CLI::App& command, SceneOptions& options) {
  std::vector<std::string> names;
  for (const auto& [name, axis] : axes()) names.push_back(name);
  command
      .add_option("--camera-height", options.camera_height, "Of the camera above the ground [m]")
      ->check(finite_number(0.05, 5.0));
  command
      .add_option("--camera-pitch", options.camera_pitch,
                  "Optical axis below the horizon; positive looks down [rad]")
      ->check(finite_number(-1.6, 1.6));
  command.add_option("--up", options.up, "Axis of the recording that is up")
      ->check(CLI::IsMember(names));
  command.add_option("--forward", options.forward, "Axis of the recording along the jump")
      ->check(CLI::IsMember(names));
  command
      .add_option("--origin", options.origin,
                  "X,Y: where the robot stands, ahead and left of the point below the sensor [m]")
      ->check(finite_number())
      ->delimiter(',')
      ->expected(2);
}

}  // namespace

void add_scene_command(CLI::App& app, Action& action) {
  CLI::App* command =
      app.add_subcommand("scene", "Terrain and landing targets of one depth image or point cloud");
  command->footer(
      "Without pose options the dominant floor plane gives up and height.\n"
      "Example: hopscotch scene depth.png --intrinsics 385,385,320,240 --out runs/scene");
  const auto options = std::make_shared<SceneOptions>();  // shared with the action below
  command->add_option("DEPTH_OR_CLOUD", options->file, "16-bit PNG, PGM or TIFF; PCD or PLY")
      ->required();
  add_depth_options(*command, options->depth);
  add_pose_options(*command, *options);
  command->add_option("--config", options->config, "Tuning")->capture_default_str();
  command->add_option("--out", options->out, "Write pictures and terrain.json to this folder");
  command->add_flag("--json", options->json, "Print one JSON object");
  command->callback([&action, options] { action = [options] { return scene(*options); }; });
}

}  // namespace hopscotch::apps
