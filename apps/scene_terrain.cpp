#include "apps/scene_terrain.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <string_view>
#include <vector>

#include "apps/stopwatch.hpp"
#include "core/config_reader.hpp"
#include "footstep/landing_selector.hpp"
#include "model/stand_posture.hpp"
#include "perception/body_mask.hpp"
#include "perception/cloud_file.hpp"
#include "perception/cloud_map.hpp"
#include "perception/depth_filter.hpp"
#include "perception/one_step.hpp"
#include "planner/step_target.hpp"

namespace hopscotch::apps {

namespace {

using perception::PointCloud;

/// Recordings look farther than the robot's own camera.
constexpr double kRangeMin = 0.20;  // [m]
constexpr double kRangeMax = 5.0;   // [m]
/// And flatter over the ground, so that it changes more from row to row than a filter for edges
/// bears; what is left of pixels in the air is levelled in the map.
constexpr double kJumpRatio = 0.08;
constexpr double kAheadMax = 4.0;   // of the place where the robot stands [m]
constexpr double kHalfWidth = 0.6;  // [m]
constexpr std::size_t kPointsMin = 300;
/// Clouds whose points are farther away than this in the median count millimetres.
constexpr double kMedianMax = 60.0;  // [m]
constexpr double kMedianMin = 0.05;  // [m]
/// Who holds a camera holds it lower [m]: an image that says otherwise is in another unit.
constexpr double kCameraHeightMax = 2.5;
/// Share of the ground ahead without a reading from which on a frame counts as degraded.
constexpr double kDropoutMax = 0.40;

void check_cloud(const std::filesystem::path& file, const PointCloud& cloud) {
  std::vector<float> ranges;
  for (const Eigen::Vector3f& p : cloud.points) {
    if (p.allFinite()) ranges.push_back(p.norm());
  }
  if (ranges.size() < kPointsMin) {
    throw core::ConfigError(file.string() + ": only " + std::to_string(ranges.size()) +
                            " points hold a usable reading; " + std::to_string(kPointsMin) +
                            " are needed");
  }
  const auto middle = ranges.begin() + static_cast<std::ptrdiff_t>(ranges.size() / 2);
  std::nth_element(ranges.begin(), middle, ranges.end());
  const double median = static_cast<double>(*middle);
  if (median >= kMedianMin && median <= kMedianMax) return;
  char text[160];
  std::snprintf(text, sizeof text,
                ": half of its points are beyond %.4g m; clouds are read in metres. "
                "Does it count millimetres or kilometres?",
                median);
  throw core::ConfigError(file.string() + text);
}

/// Share of the ground on the way ahead that an image should show and does not.
double dropout_ahead(const core::DepthFrame& frame, const Eigen::Isometry3d& X_WC, double ground) {
  constexpr double kLength = 1.5;
  constexpr double kStripHalfWidth = 0.25;
  constexpr int kStep = 4;  // every fourth pixel is enough
  int wanted = 0;
  int missing = 0;
  const core::CameraIntrinsics& lens = frame.intrinsics;
  for (int v = 0; v < lens.height; v += kStep) {
    for (int u = 0; u < lens.width; u += kStep) {
      const Eigen::Vector3d ray =
          X_WC.linear() * Eigen::Vector3d((u - lens.cx) / lens.fx, (v - lens.cy) / lens.fy, 1.0);
      if (!(ray.z() < 0.0)) continue;
      const Eigen::Vector3d p =
          X_WC.translation() + (ground - X_WC.translation().z()) / ray.z() * ray;
      if (p.x() < 0.0 || p.x() > kLength || std::abs(p.y()) > kStripHalfWidth) continue;
      ++wanted;
      const float z = frame.depth[static_cast<std::size_t>(v * lens.width + u)];
      missing += z > 0.0F ? 0 : 1;
    }
  }
  return wanted == 0 ? 0.0 : static_cast<double>(missing) / wanted;
}

/// Height under the soles: what was seen there, or else the floor.
double ground_at_origin(const core::TerrainMap& map, double floor_height) {
  constexpr double kHalfLength = 0.08;
  constexpr double kFootprintHalfWidth = 0.12;
  std::vector<float> heights;
  for (int iy = 0; iy < map.size_y; ++iy) {
    const double y = map.origin_y + (iy + 0.5) * map.resolution;
    if (std::abs(y) > kFootprintHalfWidth) continue;
    for (int ix = 0; ix < map.size_x; ++ix) {
      const double x = map.origin_x + (ix + 0.5) * map.resolution;
      const core::TerrainCell& cell = map.at(ix, iy);
      const bool seen = cell.state == core::CellState::observed;
      if (seen && std::abs(x) <= kHalfLength) heights.push_back(cell.height);
    }
  }
  if (heights.empty()) return floor_height;
  const auto middle = heights.begin() + static_cast<std::ptrdiff_t>(heights.size() / 2);
  std::nth_element(heights.begin(), middle, heights.end());
  return static_cast<double>(*middle);
}

std::vector<ReportedPlane> in_world(const std::vector<perception::PlanePatch>& planes,
                                    const Eigen::Isometry3d& X_WR) {
  constexpr double kSteepest = 0.8;  // beyond it is a wall [rad]
  std::vector<ReportedPlane> result;
  for (const perception::PlanePatch& plane : planes) {
    const double upright = std::abs((X_WR.linear() * plane.normal).z());
    const double slope = std::acos(std::min(1.0, upright));
    if (slope > kSteepest) continue;
    result.push_back({(X_WR * plane.centroid).z(), slope, plane.points});
  }
  return result;
}

/// Why the unit of an image may be another one than stated; empty where it may not. A flat floor is
/// flat in any unit, steps are not as high as they are: nothing is to be aimed at.
std::string doubt_about_unit(const SceneRecording& recording, const SceneTerrain& scene,
                             double ground) {
  const double height = scene.X_WR.translation().z() - ground;
  if (!recording.frame || height <= kCameraHeightMax) return "";
  char text[140];
  std::snprintf(text, sizeof text,
                "degraded: the camera would be %.1f m above the ground; is --depth-scale right?",
                height);
  return text;
}

/// @param floor  Nothing when the pose was stated and no floor seen.
std::string status_of(const SceneRecording& recording, const SceneTerrain& scene, double ground,
                      const std::optional<perception::PlanePatch>& floor) {
  constexpr double kFloorShareMin = 0.02;
  const double share = floor ? static_cast<double>(floor->points) /
                                   static_cast<double>(recording.cloud.points.size())
                             : 0.0;
  if (share < kFloorShareMin) {
    char text[100];
    std::snprintf(text, sizeof text, "degraded: the floor holds only %.1f %% of the readings",
                  100.0 * share);
    return text;
  }
  if (recording.frame) {
    const double dropout = dropout_ahead(*recording.frame, scene.X_WR, ground);
    if (dropout > kDropoutMax) {
      char text[100];
      std::snprintf(text, sizeof text, "degraded: %.0f %% of the ground ahead carries no reading",
                    100.0 * dropout);
      return text;
    }
  }
  return "ok";
}

/// By its first bytes or, where they say nothing, by its name: then the reader of images says what
/// is wrong with it.
bool holds_image(const std::filesystem::path& file) {
  static constexpr std::array<std::string_view, 4> kEndings{".png", ".pgm", ".tif", ".tiff"};
  const std::string ending = file.extension().string();
  return is_image_file(file) ||
         std::find(kEndings.begin(), kEndings.end(), ending) != kEndings.end();
}

}  // namespace

perception::PointCloud cloud_of(const core::DepthFrame& frame,
                                const perception::PerceptionConfig& config) {
  perception::DepthFilterConfig filter_config = config.filter;
  filter_config.range_min = kRangeMin;
  filter_config.range_max = kRangeMax;
  filter_config.jump_ratio = kJumpRatio;
  perception::DepthFilter filter(filter_config, config.noise);
  perception::BodyCapsules nobody;
  for (perception::Capsule& capsule : nobody) {
    capsule = {Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero(), 0.0};  // behind the image plane
  }
  std::vector<float> depth;
  (void)filter.filter(frame, nobody, depth);
  const core::CameraIntrinsics& lens = frame.intrinsics;
  PointCloud cloud{.width = lens.width, .height = lens.height, .points = {}};
  cloud.points.reserve(depth.size());
  for (int v = 0; v < lens.height; ++v) {
    for (int u = 0; u < lens.width; ++u) {
      const float z = depth[static_cast<std::size_t>(v * lens.width + u)];
      const double scale = z > 0.0F ? static_cast<double>(z) : core::kNaN;
      const Eigen::Vector3d ray((u - lens.cx) / lens.fx, (v - lens.cy) / lens.fy, 1.0);
      cloud.points.emplace_back((scale * ray).cast<float>());
    }
  }
  return cloud;
}

core::RobotState standing_at(const ProgramConfig& config, const model::RobotParameters& robot,
                             const Eigen::Isometry3d& X_WS) {
  const std::optional<model::StandPose> pose = model::stand_pose(robot, config.stand_posture);
  if (!pose) throw core::ConfigError("model.stand_posture: " + robot.name + " cannot stand so");
  core::RobotState state = planner::standing_state(*pose);
  state.p_WB = X_WS * state.p_WB;
  state.R_WB = X_WS.linear() * state.R_WB;
  return state;
}

SceneRecording read_scene(const SceneRequest& request, const ProgramConfig& config) {
  SceneRecording recording;
  if (holds_image(request.file)) {
    recording.frame = depth_frame_of(request.file, read_depth_image(request.file), request.scaling);
    recording.cloud = cloud_of(*recording.frame, config.perception);
  } else {
    recording.cloud = perception::read_cloud_file(request.file);
  }
  check_cloud(request.file, recording.cloud);
  return recording;
}

SceneTerrain look_at_scene(const SceneRequest& request, const SceneRecording& recording,
                           const ProgramConfig& config, const model::RobotParameters& robot) {
  const Stopwatch watch;
  const std::vector<perception::PlanePatch> planes =
      perception::segment_planes(config.perception.planes, recording.cloud);
  perception::GroundHints hints = request.hints;
  hints.optical_frame = !hints.up && (recording.frame || recording.cloud.is_organised());
  const core::Result<perception::GroundFrame> frame = find_ground_frame(planes, hints);
  if (!frame) throw core::ConfigError(request.file.string() + ": " + frame.error().sentence);

  SceneTerrain scene;
  scene.X_WR = frame->X_WR;
  std::vector<Eigen::Vector3f> points;
  points.reserve(recording.cloud.points.size());
  const Eigen::Isometry3f X_WR = frame->X_WR.cast<float>();
  for (const Eigen::Vector3f& p : recording.cloud.points) points.push_back(X_WR * p);
  const bool single = recording.frame || recording.cloud.is_organised();
  scene.map = perception::map_cloud(
      config.perception,
      {.points = points,
       .p_WC = frame->X_WR.translation(),
       .viewpoint = single ? perception::Viewpoint::single : perception::Viewpoint::many,
       .residual = frame->floor ? frame->floor->residual : 0.0},
      {.from_x = core::TerrainProfile::kStart, .to_x = kAheadMax, .half_width = kHalfWidth});

  const double ground = ground_at_origin(scene.map, frame->floor_height);
  Eigen::Isometry3d X_WS = Eigen::Isometry3d::Identity();
  X_WS.translation().z() = ground;
  const core::RobotState state = standing_at(config, robot, X_WS);
  const perception::OneStepConfig& one_step = config.perception.one_step;
  const perception::StancePose stance = perception::stance_pose(one_step, robot, state);
  TerrainReport& report = scene.report;
  report.terrain = perception::one_step_terrain(one_step, scene.map, stance);
  report.survey = perception::survey_line(one_step, scene.map, stance, kAheadMax);
  report.planes = in_world(planes, scene.X_WR);
  report.choice = footstep::LandingSelector(config.footstep, robot)
                      .choose({scene.map, report.terrain}, state, {});
  report.status = doubt_about_unit(recording, scene, ground);
  if (!report.status.empty()) {
    report.choice = {};
    report.choice.refusal = {core::Reason::terrain_unseen, "its unit is in doubt"};
  } else {
    report.status = status_of(recording, scene, ground, frame->floor);
  }
  report.latency_ms = watch.milliseconds();
  return scene;
}

}  // namespace hopscotch::apps
