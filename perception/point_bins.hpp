#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/depth_frame.hpp"
#include "core/terrain_map.hpp"

namespace hopscotch::perception {

/// A measured point within its cell.
struct MapPoint {
  float height = 0.0F;    ///< In W [m].
  float offset_x = 0.0F;  ///< From the cell's centre, along x of W [cells].
  float offset_y = 0.0F;  ///< From the cell's centre, along y of W [cells].
};

/// Two points that neighbour in the image but not on the ground: the ray to the farther one passes
/// over everything in between, which is hidden.
struct SightLine {
  Eigen::Vector3f near;         ///< In W, relative to the camera [m].
  Eigen::Vector3f far;          ///< In W, relative to the camera [m].
  std::uint32_t near_cell = 0;  ///< Index into TerrainMap::cells: the ground seen may end in it.
};

/// A depth image and where it was taken.
struct PlacedDepth {
  const core::CameraIntrinsics& intrinsics;
  std::span<const float> depth;  ///< Row by row [m]; 0 = nothing.
  Eigen::Isometry3d X_WC;
};

/// Whether a row belongs to the image half in which `near_row_step` holds.
[[nodiscard]] constexpr bool is_lower_half(const core::CameraIntrinsics& camera, double row) {
  return row > 0.5 * camera.height;
}

/// Which points are wanted.
struct BinningLimits {
  Eigen::Vector2d ahead =
      Eigen::Vector2d::UnitX();  ///< Unit vector in W along the robot's heading.
  double lateral_max = 0.0;      ///< To either side of it [m].
  int column_step = 1;           ///< Use every so many columns.
  int near_row_step = 1;  ///< Use every so many rows of the lower half, where pixels lie densely.
  double hidden_length = 0.0;  ///< Longer jumps on the ground become sight lines [m], unless the
                               ///< rows of a level surface would lie so far apart.
};

/// The points of one frame, sorted by map cell. Keeps its memory between frames.
class PointBins {
 public:
  /// Projects the image onto the grid of `map` (its cells are not read).
  void fill(const PlacedDepth& image, const core::TerrainMap& map, const BinningLimits& limits);

  /// Sorts points of W [m] into the grid of `map`; NaN is left out. Leaves no sight lines.
  void fill(std::span<const Eigen::Vector3f> points, const core::TerrainMap& map);

  [[nodiscard]] std::size_t size() const { return cells_.size(); }
  /// Index into TerrainMap::cells. @pre bin < size()
  [[nodiscard]] std::size_t cell(std::size_t bin) const { return cells_[bin]; }
  /// Points of a bin; the caller may reorder them. @pre bin < size()
  [[nodiscard]] std::span<MapPoint> points(std::size_t bin) {
    return {sorted_.data() + starts_[bin], starts_[bin + 1] - starts_[bin]};
  }
  [[nodiscard]] const std::vector<SightLine>& sight_lines() const { return sight_lines_; }

  /// The grid as it lies to the camera, in single precision.
  struct RelativeGrid {
    float x = 0.0F;  ///< Lower corner [m].
    float y = 0.0F;
    float base_height = 0.0F;  ///< Of the camera, in W [m].
    float cells_per_metre = 0.0F;
    float size_x = 0.0F;  ///< [cells]
    float size_y = 0.0F;
  };

 private:
  struct Entry {
    std::uint32_t cell;
    MapPoint point;
  };
  void project(const PlacedDepth& image, const core::TerrainMap& map, const BinningLimits& limits);
  std::optional<std::uint32_t> add(const Eigen::Vector3f& p, const RelativeGrid& grid);
  void add_between(const Eigen::Vector3f& near, const Eigen::Vector3f& far,
                   const RelativeGrid& grid);
  void sort_by_cell(std::size_t map_cells);

  std::vector<Entry> entries_;
  std::vector<SightLine> previous_;    // last point of each column as `near`, NaN = none
  std::vector<std::uint32_t> counts_;  // per map cell; zero between calls
  std::vector<std::uint32_t> cells_;
  std::vector<std::uint32_t> starts_;
  std::vector<MapPoint> sorted_;
  std::vector<SightLine> sight_lines_;
};

}  // namespace hopscotch::perception
