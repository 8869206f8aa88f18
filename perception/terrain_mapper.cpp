#include "perception/terrain_mapper.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "model/kinematics.hpp"
#include "perception/body_mask.hpp"
#include "perception/cell_height.hpp"
#include "perception/depth_filter.hpp"
#include "perception/depth_noise.hpp"
#include "perception/map_window.hpp"
#include "perception/point_bins.hpp"
#include "perception/sight_lines.hpp"

namespace hopscotch::perception {

struct TerrainMapper::Memory {
  Memory(const PerceptionConfig& config, const Eigen::Vector2d& centre)
      : filter(config.filter, config.noise), window(empty_window(config.mapper, centre)) {}

  DepthFilter filter;
  MapWindow window;
  PointBins bins;
  std::vector<float> depth;
  std::vector<CellUnderRay> under_ray;
  core::CameraIntrinsics lens;
  std::optional<PlacedDepth> image;
};

namespace {

/// Jumps on the ground beyond so many cells hide cells that no pixel can reach.
constexpr double kHiddenCells = 1.6;
/// Cells nearer to the camera's height than this are seen edge-on and say nothing about height.
constexpr double kLevelSight = 0.05;  // [m]

bool is_rotation(const Eigen::Matrix3d& R) {
  constexpr double kTolerance = 0.01;
  return R.allFinite() &&
         (R.transpose() * R - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff() <= kTolerance;
}

bool is_pose_sound(const core::RobotState& state) {
  return state.p_WB.allFinite() && is_rotation(state.R_WB) && state.q.allFinite();
}

/// Lenses of another image size put their axis beside the middle of this one or see far too much or
/// too little.
bool fits_image(const core::CameraIntrinsics& camera) {
  constexpr double kOffCentre = 0.25;  // shares of the image's size
  constexpr double kViewMin = 0.25;    // width over focal length: 14 degrees
  constexpr double kViewMax = 4.0;     // 127 degrees
  const double view = camera.width / camera.fx;
  return view >= kViewMin && view <= kViewMax &&
         std::abs(camera.cx - 0.5 * camera.width) <= kOffCentre * camera.width &&
         std::abs(camera.cy - 0.5 * camera.height) <= kOffCentre * camera.height;
}

bool is_sound(const core::DepthFrame& frame) {
  const core::CameraIntrinsics& camera = frame.intrinsics;
  const bool sized = camera.width > 0 && camera.height > 0 &&
                     frame.depth.size() == static_cast<std::size_t>(camera.width) *
                                               static_cast<std::size_t>(camera.height);
  const bool lens = std::isfinite(camera.fx) && camera.fx > 0.0 && std::isfinite(camera.fy) &&
                    camera.fy > 0.0 && std::isfinite(camera.cx) && std::isfinite(camera.cy);
  return sized && lens && fits_image(camera) && frame.X_BC.matrix().allFinite() &&
         is_rotation(frame.X_BC.linear());
}

Eigen::Isometry3d pose_of_trunk(const core::RobotState& state) {
  Eigen::Isometry3d X_WB = Eigen::Isometry3d::Identity();
  X_WB.linear() = state.R_WB;
  X_WB.translation() = state.p_WB;
  return X_WB;
}

/// Heading of the trunk on the ground; x of W when it points straight up or down.
Eigen::Vector2d heading_of(const Eigen::Isometry3d& X_WB) {
  const Eigen::Vector2d ahead = X_WB.linear().col(0).head<2>();
  const double length = ahead.norm();
  return length > 1e-6 ? Eigen::Vector2d(ahead / length) : Eigen::Vector2d(1.0, 0.0);
}

Eigen::Vector2d window_centre(const MapperConfig& config, const Eigen::Isometry3d& X_WB) {
  return X_WB.translation().head<2>() + config.window_ahead * heading_of(X_WB);
}

Eigen::Vector3d cell_centre(const core::TerrainMap& map, std::size_t cell, float height) {
  const std::size_t size_x = static_cast<std::size_t>(map.size_x);
  return {map.origin_x + (static_cast<double>(cell % size_x) + 0.5) * map.resolution,
          map.origin_y + (static_cast<double>(cell / size_x) + 0.5) * map.resolution,
          static_cast<double>(height)};
}

ViewOfCell view_of(const Eigen::Vector3d& p_WP, const Eigen::Isometry3d& X_WC) {
  const Eigen::Vector3d p_CP_W = p_WP - X_WC.translation();
  return {.depth = X_WC.linear().col(2).dot(p_CP_W),
          .horizontal = p_CP_W.head<2>().norm(),
          .rise = p_CP_W.z()};
}

struct PixelSteps {
  int column = 1;
  int near_row = 1;
};

/// The configured steps are for images of 640x480; smaller ones have no pixels to spare.
PixelSteps pixel_steps(const MapperConfig& config, const core::CameraIntrinsics& camera) {
  constexpr int kWidth = 640;
  constexpr int kHeight = 480;
  return {.column = std::max(1, config.column_step * camera.width / kWidth),
          .near_row = std::max(1, config.near_row_step * camera.height / kHeight)};
}

/// Pixels that a level surface all over a cell would get: the solid angle of the cell over that of
/// a pixel, less the pixels that are not used.
double expected_points(const MapperConfig& config, const PlacedDepth& image,
                       const Eigen::Vector3d& p_WP, const ViewOfCell& view) {
  const core::CameraIntrinsics& camera = image.intrinsics;
  const double area = config.resolution * config.resolution;
  const double pixels =
      camera.fx * camera.fy * area * std::abs(view.rise) / (view.depth * view.depth * view.depth);
  const double down = image.X_WC.linear().col(1).dot(p_WP - image.X_WC.translation());
  const double row = camera.cy + camera.fy * down / view.depth;
  const PixelSteps steps = pixel_steps(config, camera);
  const int row_step = is_lower_half(camera, row) ? steps.near_row : 1;
  return pixels / (steps.column * row_step);
}

/// Takes one reading into its cell.
void fuse_reading(const PerceptionConfig& config, const ViewOfCell& view,
                  const CellReading& reading, std::size_t index, MapWindow& window) {
  core::TerrainCell& cell = window.map.cells[index];
  CellMemory& memory = window.memory[index];
  const bool ends_here = reading.has_riser || memory.edge_frame == window.map.frames;
  if (reading.kind == CellReadingKind::off_centre && ends_here) {
    fuse_edge(config.mapper, reading.height, window.map.frames, cell, memory);
    return;
  }
  const HeightMeasurement measurement{
      .height = reading.height,
      .variance = static_cast<float>(height_variance(config.noise, view)),
      .shared_variance = static_cast<float>(shared_variance(config.noise, view))};
  fuse_height(config.mapper, measurement, cell, memory);
}

void fuse_points(const PerceptionConfig& config, const PlacedDepth& image, PointBins& bins,
                 MapWindow& window) {
  for (const SightLine& line : bins.sight_lines()) {
    window.memory[line.near_cell].edge_frame = window.map.frames;
  }
  for (std::size_t bin = 0; bin < bins.size(); ++bin) {
    const std::size_t index = bins.cell(bin);
    const std::span<MapPoint> points = bins.points(bin);
    const Eigen::Vector3d p_WP = cell_centre(window.map, index, points.front().height);
    const ViewOfCell view = view_of(p_WP, image.X_WC);
    if (!(view.depth > 0.0) || std::abs(view.rise) < kLevelSight) continue;
    const double expected = expected_points(config.mapper, image, p_WP, view);
    const CellReading reading = read_cell(config.mapper, expected, points);
    if (reading.kind == CellReadingKind::nothing) continue;
    fuse_reading(config, view, reading, index, window);
  }
}

void fuse_sight_lines(const MapperConfig& config, const Eigen::Vector3d& p_WC,
                      const PointBins& bins, std::vector<CellUnderRay>& under_ray,
                      MapWindow& window) {
  for (const SightLine& line : bins.sight_lines()) {
    cells_under_ray(window.map, p_WC, line, under_ray);
    for (const CellUnderRay& under : under_ray) {
      fuse_sight(config, under.ray_height, window.map.frames, window.map.cells[under.cell],
                 window.memory[under.cell]);
    }
  }
}

/// Marks all cells whose centre lies under one sole, or beside it within the margin.
void fuse_sole(const MapperConfig& config, const model::RobotParameters& robot,
               const Eigen::Isometry3d& X_WF, MapWindow& window) {
  core::TerrainMap& map = window.map;
  const double half_length = 0.5 * (robot.toe + robot.heel);
  const double half_width = 0.5 * robot.foot_width + config.support_margin;
  const Eigen::Isometry3d X_FW = X_WF.inverse();
  const double reach = half_length + half_width;
  const Eigen::Vector3d p = X_WF.translation();
  const int first_x = static_cast<int>((p.x() - reach - map.origin_x) / map.resolution);
  const int first_y = static_cast<int>((p.y() - reach - map.origin_y) / map.resolution);
  const int span = static_cast<int>(2.0 * reach / map.resolution) + 2;
  for (int iy = first_y; iy < first_y + span; ++iy) {
    for (int ix = first_x; ix < first_x + span; ++ix) {
      if (!map.contains(ix, iy)) continue;
      const std::size_t index = static_cast<std::size_t>(iy * map.size_x + ix);
      const Eigen::Vector3d p_F = X_FW * cell_centre(map, index, static_cast<float>(p.z()));
      if (std::abs(p_F.x()) > half_length || std::abs(p_F.y()) > half_width) continue;
      const Eigen::Vector3d on_sole = X_WF * Eigen::Vector3d(p_F.x(), p_F.y(), 0.0);
      set_support(static_cast<float>(on_sole.z()), static_cast<float>(config.support_sigma),
                  map.cells[index], window.memory[index]);
    }
  }
}

}  // namespace

TerrainMapper::TerrainMapper(const PerceptionConfig& config, const model::RobotParameters& robot)
    : config_(config),
      robot_(robot),
      memory_(std::make_unique<Memory>(config, Eigen::Vector2d(config.mapper.window_ahead, 0.0))) {}

TerrainMapper::~TerrainMapper() = default;
TerrainMapper::TerrainMapper(TerrainMapper&&) noexcept = default;
TerrainMapper& TerrainMapper::operator=(TerrainMapper&&) noexcept = default;

MapStatus TerrainMapper::integrate(const core::DepthFrame& frame,
                                   const core::RobotState& at_exposure) {
  const core::TerrainMap& map = memory_->window.map;
  if (!is_sound(frame)) return MapStatus::bad_frame;
  if (!is_pose_sound(at_exposure)) return MapStatus::bad_state;
  if (map.frames > 0 && frame.stamp <= map.stamp) return MapStatus::stale;
  // Written so that a speed that is not a number counts as too fast.
  const bool slow = at_exposure.v_WB.norm() <= config_.mapper.speed_max &&
                    at_exposure.w_WB.norm() <= config_.mapper.angular_speed_max;
  if (!slow) return MapStatus::moving;
  const Eigen::Isometry3d X_WB = pose_of_trunk(at_exposure);
  return fuse(frame, body_in_camera(robot_, at_exposure.q, frame.X_BC), X_WB * frame.X_BC, X_WB);
}

MapStatus TerrainMapper::integrate(const core::DepthFrame& frame, const Eigen::Isometry3d& X_WC) {
  const core::TerrainMap& map = memory_->window.map;
  if (!is_sound(frame)) return MapStatus::bad_frame;
  if (!X_WC.matrix().allFinite()) return MapStatus::bad_state;
  if (map.frames > 0 && frame.stamp <= map.stamp) return MapStatus::stale;
  BodyCapsules nobody;
  for (Capsule& capsule : nobody) {
    capsule = {Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero(), 0.0};  // behind the image plane
  }
  Eigen::Isometry3d X_WB = Eigen::Isometry3d::Identity();
  X_WB.translation() = X_WC.translation();
  X_WB.linear().col(0) = X_WC.linear().col(2);  // the camera looks ahead
  return fuse(frame, nobody, X_WC, X_WB);
}

MapStatus TerrainMapper::fuse(const core::DepthFrame& frame, const BodyCapsules& body,
                              const Eigen::Isometry3d& X_WC, const Eigen::Isometry3d& X_WB) {
  core::TerrainMap& map = memory_->window.map;
  if (memory_->filter.filter(frame, body, memory_->depth).kept == 0) return MapStatus::blind;
  follow(config_.mapper, window_centre(config_.mapper, X_WB), memory_->window);
  const PixelSteps steps = pixel_steps(config_.mapper, frame.intrinsics);
  const BinningLimits limits{.ahead = heading_of(X_WB),
                             .lateral_max = config_.mapper.lateral_max,
                             .column_step = steps.column,
                             .near_row_step = steps.near_row,
                             .hidden_length = kHiddenCells * config_.mapper.resolution};
  memory_->lens = frame.intrinsics;
  memory_->image.emplace(PlacedDepth{memory_->lens, memory_->depth, X_WC});
  const PlacedDepth& image = *memory_->image;
  memory_->bins.fill(image, map, limits);
  fuse_points(config_, image, memory_->bins, memory_->window);
  fuse_sight_lines(config_.mapper, X_WC.translation(), memory_->bins, memory_->under_ray,
                   memory_->window);
  map.stamp = frame.stamp;
  ++map.frames;
  return MapStatus::fused;
}

MapStatus TerrainMapper::anchor_support(const core::RobotState& state) {
  if (!is_pose_sound(state)) return MapStatus::bad_state;
  follow(config_.mapper, window_centre(config_.mapper, pose_of_trunk(state)), memory_->window);
  for (const Eigen::Isometry3d& X_WF : model::sole_poses(robot_, state)) {
    fuse_sole(config_.mapper, robot_, X_WF, memory_->window);
  }
  return MapStatus::fused;
}

const std::optional<PlacedDepth>& TerrainMapper::image() const {
  return memory_->image;
}

const core::TerrainMap& TerrainMapper::map() const {
  return memory_->window.map;
}

}  // namespace hopscotch::perception
