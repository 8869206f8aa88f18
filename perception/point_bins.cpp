#include "perception/point_bins.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace hopscotch::perception {

namespace {

/// Points farther apart than this leave cells between them without one [cells].
constexpr float kSparseCells = 1.0F;

PointBins::RelativeGrid relative_grid(const core::TerrainMap& map, const Eigen::Vector3d& p_WC) {
  return {.x = static_cast<float>(map.origin_x - p_WC.x()),
          .y = static_cast<float>(map.origin_y - p_WC.y()),
          .base_height = static_cast<float>(p_WC.z()),
          .cells_per_metre = static_cast<float>(1.0 / map.resolution),
          .size_x = static_cast<float>(map.size_x),
          .size_y = static_cast<float>(map.size_y)};
}

/// Ray of a pixel as row_start + column * per_column, with z of C equal to one.
struct RowRays {
  Eigen::Vector3f row_start;
  Eigen::Vector3f per_column;
};

RowRays row_rays(const PlacedDepth& image, int row) {
  const core::CameraIntrinsics& camera = image.intrinsics;
  const Eigen::Matrix3d R = image.X_WC.linear();
  const Eigen::Vector3d per_column = R.col(0) / camera.fx;
  const Eigen::Vector3d row_start =
      R.col(2) + R.col(1) * ((row - camera.cy) / camera.fy) - per_column * camera.cx;
  return {row_start.cast<float>(), per_column.cast<float>()};
}

/// Whether level ground at `p`, relative to the camera, would not have put the next row's pixel so
/// far ahead on the ground: rows of a far surface lie wider apart than cells.
bool is_jump(const core::CameraIntrinsics& camera, const Eigen::Vector3f& p, float length_squared) {
  constexpr float kWider = 1.6F;
  const float drop = -p.z();
  if (!(drop > 0.0F)) return true;
  const float spacing = kWider * p.squaredNorm() / (drop * static_cast<float>(camera.fy));
  return length_squared > spacing * spacing;
}

}  // namespace

/// Takes in a point relative to the camera; nothing when it lies outside the grid.
inline std::optional<std::uint32_t> PointBins::add(const Eigen::Vector3f& p,
                                                   const RelativeGrid& grid) {
  const float grid_x = (p.x() - grid.x) * grid.cells_per_metre;
  const float grid_y = (p.y() - grid.y) * grid.cells_per_metre;
  if (!(grid_x >= 0.0F && grid_x < grid.size_x)) return std::nullopt;
  if (!(grid_y >= 0.0F && grid_y < grid.size_y)) return std::nullopt;
  const int ix = static_cast<int>(grid_x);
  const int iy = static_cast<int>(grid_y);
  const std::uint32_t cell = static_cast<std::uint32_t>(iy * static_cast<int>(grid.size_x) + ix);
  entries_.push_back({cell,
                      {p.z() + grid.base_height, grid_x - static_cast<float>(ix) - 0.5F,
                       grid_y - static_cast<float>(iy) - 0.5F}});
  return cell;
}

void PointBins::fill(const PlacedDepth& image, const core::TerrainMap& map,
                     const BinningLimits& limits) {
  project(image, map, limits);
  sort_by_cell(map.cells.size());
}

void PointBins::fill(std::span<const Eigen::Vector3f> points, const core::TerrainMap& map) {
  entries_.clear();
  sight_lines_.clear();
  const RelativeGrid grid = relative_grid(map, Eigen::Vector3d::Zero());
  for (const Eigen::Vector3f& p : points) static_cast<void>(add(p, grid));
  sort_by_cell(map.cells.size());
}

void PointBins::project(const PlacedDepth& image, const core::TerrainMap& map,
                        const BinningLimits& limits) {
  const int columns = image.intrinsics.width;
  SightLine nowhere;
  nowhere.near.setConstant(std::numeric_limits<float>::quiet_NaN());
  const RelativeGrid grid = relative_grid(map, image.X_WC.translation());
  const Eigen::Vector2f ahead = limits.ahead.cast<float>();
  const float lateral_max = static_cast<float>(limits.lateral_max);
  const float hidden_squared = static_cast<float>(limits.hidden_length * limits.hidden_length);
  const float sparse = kSparseCells * static_cast<float>(map.resolution);

  entries_.clear();
  sight_lines_.clear();
  previous_.assign(static_cast<std::size_t>(columns), nowhere);
  for (int row = image.intrinsics.height - 1; row >= 0;
       row -= is_lower_half(image.intrinsics, row) ? limits.near_row_step : 1) {  // near to far
    const RowRays rays = row_rays(image, row);
    const float* depth = image.depth.data() + static_cast<std::ptrdiff_t>(row) * columns;
    for (int column = 0; column < columns; column += limits.column_step) {
      if (!(depth[column] > 0.0F)) continue;
      const Eigen::Vector3f p =
          depth[column] * (rays.row_start + static_cast<float>(column) * rays.per_column);
      if (!(std::abs(ahead.x() * p.y() - ahead.y() * p.x()) <= lateral_max)) continue;
      const std::optional<std::uint32_t> cell = add(p, grid);
      if (!cell) continue;
      SightLine& previous = previous_[static_cast<std::size_t>(column)];
      const float length_squared = (p - previous.near).head<2>().squaredNorm();
      if (length_squared > hidden_squared && is_jump(image.intrinsics, p, length_squared)) {
        sight_lines_.push_back({previous.near, p, previous.near_cell});
      } else if (length_squared > sparse * sparse) {
        add_between(previous.near, p, grid);
      }
      previous.near = p;
      previous.near_cell = *cell;
    }
  }
}

/// Where rows of one surface lie wider apart than cells, the cells between get what lies between.
void PointBins::add_between(const Eigen::Vector3f& near, const Eigen::Vector3f& far,
                            const RelativeGrid& grid) {
  constexpr float kSameSurface = 0.01F;  // [m]
  constexpr int kMost = 6;
  const Eigen::Vector3f step = far - near;
  if (!(std::abs(step.z()) <= kSameSurface)) return;
  constexpr float kPiecesPerCell = 1.5F;
  const float cells = step.head<2>().norm() * grid.cells_per_metre;
  const int pieces = std::min(kMost, static_cast<int>(kPiecesPerCell * cells) + 1);
  for (int i = 1; i < pieces; ++i) {
    static_cast<void>(add(near + static_cast<float>(i) / static_cast<float>(pieces) * step, grid));
  }
}

void PointBins::sort_by_cell(std::size_t map_cells) {
  counts_.resize(map_cells, 0);
  cells_.clear();
  for (const Entry& entry : entries_) {
    if (counts_[entry.cell]++ == 0) cells_.push_back(entry.cell);
  }
  starts_.resize(cells_.size() + 1);
  std::uint32_t start = 0;
  for (std::size_t bin = 0; bin < cells_.size(); ++bin) {
    starts_[bin] = start;
    start += counts_[cells_[bin]];
    counts_[cells_[bin]] = starts_[bin];  // from here on: where the cell's next point goes
  }
  starts_.back() = start;
  sorted_.resize(start);
  for (const Entry& entry : entries_) sorted_[counts_[entry.cell]++] = entry.point;
  for (const std::uint32_t cell : cells_) counts_[cell] = 0;
}

}  // namespace hopscotch::perception
