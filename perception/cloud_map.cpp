#include "perception/cloud_map.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "perception/cell_height.hpp"
#include "perception/depth_noise.hpp"
#include "perception/point_bins.hpp"
#include "perception/sight_lines.hpp"

namespace hopscotch::perception {

namespace {

using core::CellState;

/// Standard deviation given to bridged cells [m]: more than any foothold may have.
constexpr double kBridgedSigma = 0.02;
/// A single recording is not dense enough for smaller cells [m].
constexpr double kCellMin = 0.015;
constexpr int kBridgeMax = 2;            // [cells]
constexpr double kBridgeStep = 0.010;    // most that the rims of a hole may differ [m]
constexpr int kNeighbourhood = 4;        // half width over which density is compared [cells]
constexpr double kHiddenCells = 3.0;     // longer jumps on the ground become sight lines
constexpr int kSpeckRim = 2;             // surroundings of a speck [cells]
constexpr int kSpeckAlike = 2;           // a cell with so many like it beside it is no speck
constexpr float kSpeckHeight = 0.03F;    // [m]
constexpr double kSectorAngle = 0.0035;  // of azimuth, in which points lie behind each other [rad]

core::TerrainMap empty_map(const MapperConfig& config, const MapArea& area) {
  core::TerrainMap map;
  map.resolution = std::max(config.resolution, kCellMin);
  map.origin_x = std::floor(area.from_x / map.resolution) * map.resolution;
  map.origin_y = -std::ceil(area.half_width / map.resolution) * map.resolution;
  map.size_x = static_cast<int>(std::ceil((area.to_x - map.origin_x) / map.resolution));
  map.size_y = 2 * static_cast<int>(std::ceil(area.half_width / map.resolution));
  map.cells.assign(static_cast<std::size_t>(map.size_x) * static_cast<std::size_t>(map.size_y),
                   {.upper = std::numeric_limits<float>::infinity()});
  map.frames = 1;
  return map;
}

/// Points that a covered cell gets: the median over the occupied cells around it.
class Density {
 public:
  Density(const core::TerrainMap& map, PointBins& bins) : map_(map), counts_(map.cells.size(), 0) {
    for (std::size_t bin = 0; bin < bins.size(); ++bin) {
      counts_[bins.cell(bin)] = static_cast<int>(bins.points(bin).size());
    }
  }

  [[nodiscard]] double around(std::size_t cell) {
    const int cx = static_cast<int>(cell) % map_.size_x;
    const int cy = static_cast<int>(cell) / map_.size_x;
    near_.clear();
    for (int iy = cy - kNeighbourhood; iy <= cy + kNeighbourhood; ++iy) {
      for (int ix = cx - kNeighbourhood; ix <= cx + kNeighbourhood; ++ix) {
        if (!map_.contains(ix, iy)) continue;
        const int count = counts_[static_cast<std::size_t>(iy * map_.size_x + ix)];
        if (count > 0) near_.push_back(count);
      }
    }
    const auto middle = near_.begin() + static_cast<std::ptrdiff_t>(near_.size() / 2);
    std::nth_element(near_.begin(), middle, near_.end());
    return *middle;
  }

 private:
  const core::TerrainMap& map_;
  std::vector<int> counts_;
  std::vector<int> near_;
};

double reading_variance(const PerceptionConfig& config, const PlacedCloud& cloud,
                        const Eigen::Vector3d& p_W, std::size_t points) {
  if (cloud.viewpoint == Viewpoint::many) {
    const double scatter = cloud.residual * cloud.residual / static_cast<double>(points);
    return scatter + config.noise.floor * config.noise.floor;
  }
  const Eigen::Vector3d p_CP = p_W - cloud.p_WC;
  const double range = std::max(0.1, p_CP.norm());
  return height_variance(config.noise,
                         {.depth = range, .horizontal = p_CP.head<2>().norm(), .rise = p_CP.z()});
}

struct Ray {
  int sector;
  float slope;
  Eigen::Vector3f p;
};

/// Rays of a single viewpoint, in each sector of azimuth from near to far ground.
std::vector<Ray> sorted_rays(const PlacedCloud& cloud) {
  std::vector<Ray> rays;
  const Eigen::Vector3f p_WC = cloud.p_WC.cast<float>();
  for (const Eigen::Vector3f& point : cloud.points) {
    const Eigen::Vector3f p = point - p_WC;
    const float far = p.head<2>().norm();
    if (!(far > 1e-3F)) continue;
    const double azimuth = std::atan2(static_cast<double>(p.y()), static_cast<double>(p.x()));
    rays.push_back({static_cast<int>(std::floor(azimuth / kSectorAngle)), p.z() / far, p});
  }
  std::sort(rays.begin(), rays.end(), [](const Ray& a, const Ray& b) {
    return a.sector != b.sector ? a.sector < b.sector : a.slope < b.slope;
  });
  return rays;
}

/// Difference in slope between rays that are rows of the sensor.
float row_step(const std::vector<Ray>& rays) {
  std::vector<float> steps;
  for (std::size_t i = 1; i < rays.size(); ++i) {
    if (rays[i].sector == rays[i - 1].sector) steps.push_back(rays[i].slope - rays[i - 1].slope);
  }
  if (steps.empty()) return 0.0F;
  const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
  std::nth_element(steps.begin(), middle, steps.end());
  return *middle;
}

/// What pairs of rays that follow each other tell of the ground between their ends.
struct Between {
  std::vector<SightLine> hidden;  ///< Much farther, with rows missing or another height: hidden.
  std::vector<SightLine> rows;    ///< The next row on the same level: only thinly sampled.
};

Between between_rays(const PlacedCloud& cloud, const core::TerrainMap& map) {
  constexpr float kRows = 3.0F;        // of missing rows, more may hide something
  constexpr float kSameLevel = 0.01F;  // [m]
  constexpr float kRowsMax = 0.15F;    // apart; beyond, a hop could lie between [m]
  const std::vector<Ray> rays = sorted_rays(cloud);
  const float next_row = kRows * row_step(rays);
  const Eigen::Vector3f p_WC = cloud.p_WC.cast<float>();
  const float far_apart = static_cast<float>(kHiddenCells * map.resolution);
  Between between;
  for (std::size_t i = 1; i < rays.size(); ++i) {
    if (rays[i].sector != rays[i - 1].sector) continue;
    const Eigen::Vector3f& near = rays[i - 1].p;
    const Eigen::Vector3f& far = rays[i].p;
    const float apart = far.head<2>().norm() - near.head<2>().norm();
    if (apart <= static_cast<float>(map.resolution)) continue;
    const int ix =
        static_cast<int>(std::floor((near.x() + p_WC.x() - map.origin_x) / map.resolution));
    const int iy =
        static_cast<int>(std::floor((near.y() + p_WC.y() - map.origin_y) / map.resolution));
    if (!map.contains(ix, iy)) continue;
    const SightLine line{near, far, static_cast<std::uint32_t>(iy * map.size_x + ix)};
    const bool level = std::abs(far.z() - near.z()) <= kSameLevel;
    if (level && apart <= kRowsMax && rays[i].slope - rays[i - 1].slope <= next_row) {
      between.rows.push_back(line);
    } else if (apart > far_apart) {
      between.hidden.push_back(line);
    }
  }
  return between;
}

core::TerrainCell bridged(float height) {
  return {.height = height,
          .variance = static_cast<float>(kBridgedSigma * kBridgedSigma),
          .upper = height + 2.0F * static_cast<float>(kBridgedSigma),
          .state = CellState::observed};
}

/// Fills the cells between two rows that lie farther apart than a cell.
void bridge_rows(const PlacedCloud& cloud, const std::vector<SightLine>& rows,
                 core::TerrainMap& map) {
  constexpr int kParts = 16;           // finer than a cell at the most that rows lie apart
  constexpr float kSameLevel = 0.01F;  // [m]
  const core::TerrainMap seen = map;
  const auto is_ground = [&](const Eigen::Vector3f& end) {
    const Eigen::Vector3d p = cloud.p_WC + end.cast<double>();
    const int ix = static_cast<int>(std::floor((p.x() - map.origin_x) / map.resolution));
    const int iy = static_cast<int>(std::floor((p.y() - map.origin_y) / map.resolution));
    if (!seen.contains(ix, iy) || seen.at(ix, iy).state != CellState::observed) return false;
    return std::abs(seen.at(ix, iy).height - static_cast<float>(p.z())) <= kSameLevel;
  };
  for (const SightLine& line : rows) {
    if (!is_ground(line.near) || !is_ground(line.far)) continue;
    for (int i = 1; i < kParts; ++i) {
      const float share = static_cast<float>(i) / static_cast<float>(kParts);
      const Eigen::Vector3d p =
          cloud.p_WC + (line.near + share * (line.far - line.near)).cast<double>();
      const int ix = static_cast<int>(std::floor((p.x() - map.origin_x) / map.resolution));
      const int iy = static_cast<int>(std::floor((p.y() - map.origin_y) / map.resolution));
      if (!map.contains(ix, iy) || map.at(ix, iy).state == CellState::observed) continue;
      map.at(ix, iy) = bridged(static_cast<float>(p.z()));
    }
  }
}

void bound_hidden(const PlacedCloud& cloud, const std::vector<SightLine>& lines,
                  core::TerrainMap& map) {
  std::vector<CellUnderRay> under_ray;
  for (const SightLine& line : lines) {
    cells_under_ray(map, cloud.p_WC, line, under_ray);
    for (const CellUnderRay& under : under_ray) {
      core::TerrainCell& cell = map.cells[under.cell];
      if (cell.state == CellState::observed) continue;
      cell.upper = std::min(cell.upper, under.ray_height);
      cell.state = CellState::occluded;
    }
  }
}

/// Turns the points of a cell into what is known of it.
class CellReader {
 public:
  CellReader(const PerceptionConfig& config, const PlacedCloud& cloud,
             const std::vector<bool>& ends, Density density)
      : config_(config),
        reading_config_(config.mapper),
        cloud_(cloud),
        ends_(ends),
        density_(std::move(density)) {
    constexpr double kLayerSigmas = 4.0;
    reading_config_.cluster_height =
        std::max(config.mapper.cluster_height, kLayerSigmas * cloud.residual);
  }

  /// Points that a covered cell gets there.
  [[nodiscard]] double covered(std::size_t index) { return density_.around(index); }

  void read(std::size_t index, std::span<MapPoint> points, core::TerrainMap& map) {
    const CellReading reading = read_cell(reading_config_, density_.around(index), points);
    if (reading.kind == CellReadingKind::nothing) return;
    core::TerrainCell& cell = map.cells[index];
    if (reading.kind == CellReadingKind::off_centre && (reading.has_riser || ends_[index])) {
      cell = {.upper = reading.height, .state = CellState::occluded};
      return;
    }
    const double x = map.origin_x + (static_cast<int>(index) % map.size_x + 0.5) * map.resolution;
    const double y = map.origin_y + (static_cast<int>(index) / map.size_x + 0.5) * map.resolution;
    const double variance = reading_variance(
        config_, cloud_, {x, y, static_cast<double>(reading.height)}, points.size());
    cell = {.height = reading.height,
            .variance = static_cast<float>(variance),
            .upper = reading.height + 2.0F * static_cast<float>(std::sqrt(variance)),
            .state = CellState::observed};
  }

 private:
  const PerceptionConfig& config_;
  MapperConfig reading_config_;
  const PlacedCloud& cloud_;
  const std::vector<bool>& ends_;
  Density density_;
};

/// Heights around a cell; empty when the cell has others of its own height beside it.
std::vector<float> heights_around_speck(const core::TerrainMap& map, std::size_t index) {
  const int cx = static_cast<int>(index) % map.size_x;
  const int cy = static_cast<int>(index) / map.size_x;
  const float own = map.cells[index].height;
  int alike = 0;
  std::vector<float> around;
  for (int iy = cy - kSpeckRim; iy <= cy + kSpeckRim; ++iy) {
    for (int ix = cx - kSpeckRim; ix <= cx + kSpeckRim; ++ix) {
      const bool own_cell = ix == cx && iy == cy;
      if (own_cell || !map.contains(ix, iy)) continue;
      if (map.at(ix, iy).state != CellState::observed) continue;
      const float height = map.at(ix, iy).height;
      const bool beside = std::abs(ix - cx) <= 1 && std::abs(iy - cy) <= 1;
      if (beside && std::abs(height - own) <= kSpeckHeight) ++alike;
      around.push_back(height);
    }
  }
  if (alike >= kSpeckAlike) around.clear();
  return around;
}

/// Points between an edge and what lies behind it hang in the air and lift single cells. A cell
/// that stands alone above its surroundings by a few points is read again without them.
void level_specks(CellReader& reader, PointBins& bins, core::TerrainMap& map) {
  const core::TerrainMap seen = map;
  for (std::size_t bin = 0; bin < bins.size(); ++bin) {
    const std::size_t index = bins.cell(bin);
    if (seen.cells[index].state != CellState::observed) continue;
    std::vector<float> around = heights_around_speck(seen, index);
    if (around.empty()) continue;
    const auto middle = around.begin() + static_cast<std::ptrdiff_t>(around.size() / 2);
    std::nth_element(around.begin(), middle, around.end());
    if (seen.cells[index].height < *middle + kSpeckHeight) continue;
    const std::span<MapPoint> points = bins.points(bin);
    const auto above = std::partition(points.begin(), points.end(), [&](const MapPoint& point) {
      return point.height <= *middle + kSpeckHeight;
    });
    // A pole is as thin, but many points lie on it.
    if (static_cast<double>(points.end() - above) >= reader.covered(index)) continue;
    map.cells[index] = {.upper = std::numeric_limits<float>::infinity()};
    reader.read(index, points.first(static_cast<std::size_t>(above - points.begin())), map);
  }
}

/// Bridges short holes along one direction of the grid.
void bridge(core::TerrainMap& map, int step_x, int step_y) {
  const std::vector<core::TerrainCell> seen = map.cells;
  const auto at = [&](int ix, int iy) -> const core::TerrainCell* {
    if (!map.contains(ix, iy)) return nullptr;
    const core::TerrainCell& cell = seen[static_cast<std::size_t>(iy * map.size_x + ix)];
    return cell.state == CellState::observed ? &cell : nullptr;
  };
  for (int iy = 0; iy < map.size_y; ++iy) {
    for (int ix = 0; ix < map.size_x; ++ix) {
      const core::TerrainCell* before = at(ix, iy);
      if (before == nullptr || at(ix + step_x, iy + step_y) != nullptr) continue;
      for (int length = 1; length <= kBridgeMax; ++length) {
        const core::TerrainCell* behind =
            at(ix + (length + 1) * step_x, iy + (length + 1) * step_y);
        if (behind == nullptr) continue;
        if (std::abs(behind->height - before->height) > kBridgeStep) break;
        for (int i = 1; i <= length; ++i) {
          const float share = static_cast<float>(i) / static_cast<float>(length + 1);
          const float height = before->height + share * (behind->height - before->height);
          map.at(ix + i * step_x, iy + i * step_y) = bridged(height);
        }
        break;
      }
    }
  }
}

}  // namespace

core::TerrainMap map_cloud(const PerceptionConfig& config, const PlacedCloud& cloud,
                           const MapArea& area) {
  core::TerrainMap map = empty_map(config.mapper, area);
  PointBins bins;
  bins.fill(cloud.points, map);
  Between between;
  if (cloud.viewpoint == Viewpoint::single) between = between_rays(cloud, map);
  std::vector<bool> ends(map.cells.size(), false);
  for (const SightLine& line : between.hidden) ends[line.near_cell] = true;
  CellReader reader(config, cloud, ends, Density(map, bins));
  for (std::size_t bin = 0; bin < bins.size(); ++bin) {
    reader.read(bins.cell(bin), bins.points(bin), map);
  }
  level_specks(reader, bins, map);
  bound_hidden(cloud, between.hidden, map);
  bridge_rows(cloud, between.rows, map);
  bridge(map, 1, 0);
  bridge(map, 0, 1);
  return map;
}

}  // namespace hopscotch::perception
