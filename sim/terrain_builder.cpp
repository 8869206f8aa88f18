#include "sim/terrain_builder.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <locale>
#include <sstream>
#include <utility>

#include "sim/robot_builder.hpp"

namespace hopscotch::sim {
namespace {

constexpr double kPlateThickness = 0.06;  // [m] of a sloped top; 50 times the deepest penetration
constexpr double kFloorReach = 100.0;     // [m] drawn half size of the pit floor; it never ends

/// What every touchable geom of the terrain has. With the higher priority its friction counts, not
/// the larger one of sole and ground.
std::string touchable(double friction) {
  return " contype=\"" + std::to_string(kTerrainContype) + "\" conaffinity=\"" +
         std::to_string(kTerrainConaffinity) + "\" priority=\"1\" " + contact_attributes(friction);
}

// Two tones so that neighbouring slabs can be told apart.
constexpr std::array<std::string_view, 2> kSlabMaterials{"slab_light", "slab_dark"};

struct BoxGeom {
  std::string name;
  Eigen::Vector3d centre;
  Eigen::Vector3d half_extents;
  Eigen::Quaterniond rotation;
};

class GeomWriter {
 public:
  GeomWriter() {
    out_.imbue(std::locale::classic());
    out_.precision(std::numeric_limits<double>::max_digits10);
  }

  void box(const BoxGeom& box, double friction, std::string_view material) {
    const Eigen::Quaterniond& r = box.rotation;
    out_ << "<geom type=\"box\" name=\"" << box.name << "\" pos=\"" << box.centre.transpose()
         << "\" size=\"" << box.half_extents.transpose() << "\" quat=\"" << r.w() << ' ' << r.x()
         << ' ' << r.y() << ' ' << r.z() << "\"" << touchable(friction) << " material=\""
         << material << "\"/>\n";
  }

  void floor(double height, double friction) {
    out_ << "<geom type=\"plane\" name=\"" << kPitFloorName << "\" pos=\"0 0 " << height
         << "\" size=\"" << kFloorReach << ' ' << kFloorReach << " 1\"" << touchable(friction)
         << " material=\"pit\"/>\n";
  }

  [[nodiscard]] std::string text() const { return out_.str(); }

 private:
  std::ostringstream out_;
};

std::string slab_name(std::size_t index, std::string_view part) {
  return std::string(kSlabPrefix) + std::to_string(index) + "." + std::string(part);
}

Eigen::Quaterniond about_z(double yaw) {
  return Eigen::Quaterniond(Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()));
}

/// The box whose upper face is the slab's top.
BoxGeom plate(const Slab& slab, std::string name, double thickness) {
  const Eigen::Quaterniond rotation =
      about_z(slab.yaw) * Eigen::AngleAxisd(-slab.slope, Eigen::Vector3d::UnitY());
  const Eigen::Vector3d middle(slab.centre.x(), slab.centre.y(), slab.height(slab.centre));
  return {.name = std::move(name),
          .centre = middle - 0.5 * thickness * (rotation * Eigen::Vector3d::UnitZ()),
          .half_extents = {slab.half_size.x() / std::cos(slab.slope), slab.half_size.y(),
                           0.5 * thickness},
          .rotation = rotation};
}

void write_slab(GeomWriter& writer, std::size_t index, const Slab& slab, double pit_depth) {
  const std::string_view material = kSlabMaterials[index % kSlabMaterials.size()];
  if (slab.slope == 0.0) {
    writer.box(plate(slab, slab_name(index, "top"), slab.top + pit_depth), slab.friction, material);
    return;
  }
  writer.box(plate(slab, slab_name(index, "top"), kPlateThickness), slab.friction, material);
  Slab level = slab;
  level.slope = 0.0;
  level.top = slab.lowest() - kPlateThickness * std::cos(slab.slope);
  if (level.top <= -pit_depth) return;
  writer.box(plate(level, slab_name(index, "base"), level.top + pit_depth), slab.friction,
             material);
}

constexpr std::string_view kAssets = R"(
<texture name="sky" type="skybox" builtin="gradient" rgb1=".93 .95 .98" rgb2=".62 .71 .82"
 width="256" height="256"/>
<texture name="pit" type="2d" builtin="checker" rgb1=".36 .39 .44" rgb2=".32 .35 .40" width="256"
 height="256"/>
<material name="pit" texture="pit" texrepeat="2 2" texuniform="true" specular=".1"/>
<material name="slab_light" rgba=".83 .79 .71 1" specular=".2" shininess=".2"/>
<material name="slab_dark" rgba=".75 .70 .61 1" specular=".2" shininess=".2"/>
)";

constexpr std::string_view kLights = R"(
<light directional="true" pos="0 0 4" dir=".5 -.3 -1" diffuse=".25 .26 .30" ambient=".05 .05 .06"
 specular="0 0 0" castshadow="false"/>
)";

core::TerrainCell known_cell(double height) {
  constexpr float kVariance = 1e-8F;  // [m^2] (0.1 mm)^2
  const auto h = static_cast<float>(height);
  return {.height = h, .variance = kVariance, .upper = h, .state = core::CellState::observed};
}

/// Index of the cell that holds a coordinate, clamped to the map.
int cell_index(double coordinate, double origin, const core::TerrainMap& map, int size) {
  const double index = std::floor((coordinate - origin) / map.resolution);
  return static_cast<int>(std::clamp(index, 0.0, size - 1.0));
}

/// Sets the cells whose centres lie on the slab.
void draw_slab(const Slab& slab, core::TerrainMap& map) {
  Eigen::AlignedBox2d outline;
  for (const Eigen::Vector3d& corner : slab.top_corners()) outline.extend(corner.head<2>());
  const int first_x = cell_index(outline.min().x(), map.origin_x, map, map.size_x);
  const int last_x = cell_index(outline.max().x(), map.origin_x, map, map.size_x);
  const int first_y = cell_index(outline.min().y(), map.origin_y, map, map.size_y);
  const int last_y = cell_index(outline.max().y(), map.origin_y, map, map.size_y);
  for (int iy = first_y; iy <= last_y; ++iy) {
    for (int ix = first_x; ix <= last_x; ++ix) {
      const Eigen::Vector2d p(map.origin_x + (ix + 0.5) * map.resolution,
                              map.origin_y + (iy + 0.5) * map.resolution);
      if (slab.contains(p)) map.at(ix, iy) = known_cell(slab.height(p));
    }
  }
}

}  // namespace

TerrainXml terrain_xml(const Terrain& terrain) {
  constexpr double kPitFriction = 0.6;  // nobody stands there
  GeomWriter writer;
  writer.floor(-terrain.pit_depth, kPitFriction);
  for (std::size_t i = 0; i < terrain.slabs.size(); ++i) {
    write_slab(writer, i, terrain.slabs[i], terrain.pit_depth);
  }
  return {.assets = std::string(kAssets), .world = std::string(kLights) + writer.text()};
}

core::TerrainMap seen_terrain_map(const Terrain& seen, const Eigen::Vector2d& centre,
                                  core::Stamp stamp) {
  constexpr double kResolution = 0.015;  // [m] that of perception
  constexpr int kCells = 268;  // even; 4.02 m: what lies within two jumps in any direction
  core::TerrainMap map;
  map.stamp = stamp;
  map.resolution = kResolution;
  map.size_x = kCells;
  map.size_y = kCells;
  map.origin_x = kResolution * (std::floor(centre.x() / kResolution) - 0.5 * kCells);
  map.origin_y = kResolution * (std::floor(centre.y() / kResolution) - 0.5 * kCells);
  map.frames = 1;
  map.cells.assign(static_cast<std::size_t>(kCells) * kCells, known_cell(-seen.pit_depth));
  for (const Slab& slab : seen.slabs) draw_slab(slab, map);
  return map;
}

}  // namespace hopscotch::sim
