#include "sim/terrain_builder.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "sim/mujoco_model.hpp"
#include "sim/random.hpp"
#include "sim/xml_element.hpp"

namespace hopscotch::sim {
namespace {

Slab slab_at(double x, double y, double top) {
  Slab slab;
  slab.centre = {x, y};
  slab.half_size = {0.3, 0.2};
  slab.top = top;
  return slab;
}

/// Level, yawed, rising and falling slabs.
Terrain varied_terrain() {
  Terrain terrain;
  terrain.pit_depth = 0.4;
  terrain.slabs = {slab_at(0.0, 0.0, 0.0), slab_at(1.0, 0.2, 0.15), slab_at(2.0, 0.0, 0.05),
                   slab_at(3.0, 0.0, -0.1)};
  terrain.slabs[1].yaw = 0.5;
  terrain.slabs[2].slope = 0.2;
  terrain.slabs[2].yaw = -0.3;
  terrain.slabs[3].slope = -0.15;
  terrain.slabs[3].friction = 0.3;
  return terrain;
}

struct CompiledTerrain {
  ModelPointer model;
  DataPointer data;

  explicit CompiledTerrain(const Terrain& terrain) {
    const TerrainXml xml = terrain_xml(terrain);
    model = compile_model(XmlElement("mujoco")
                              .with("model", "terrain")
                              .containing(XmlElement("asset").containing(xml.assets).text())
                              .containing(XmlElement("worldbody").containing(xml.world).text())
                              .text());
    data = make_data(*model);
    mj_forward(model.get(), data.get());
  }

  /// Height of the first geom that a plumb line from above meets [m].
  [[nodiscard]] double height(const Eigen::Vector2d& p) const {
    constexpr double kAbove = 5.0;
    const std::array<double, 3> from{p.x(), p.y(), kAbove};
    const std::array<double, 3> down{0.0, 0.0, -1.0};
    int geom = -1;
    return kAbove -
           mj_ray(model.get(), data.get(), from.data(), down.data(), nullptr, 1, -1, &geom);
  }
};

TEST(TerrainXml, MujocoMeetsTheGroundExactlyWhereTheTerrainSaysItIs) {
  constexpr double kRayAccuracy = 1e-9;  // [m]
  const Terrain terrain = varied_terrain();
  const CompiledTerrain compiled(terrain);
  Random random(99);
  int on_slabs = 0;
  for (int i = 0; i < 2000; ++i) {
    const Eigen::Vector2d p(1.5 + 2.2 * random.uniform(), 0.7 * random.uniform());
    // The sides of sloped plates lean: stay clear of their edges by the most they can lean out.
    const bool near_edge =
        std::any_of(terrain.slabs.begin(), terrain.slabs.end(), [&](const Slab& slab) {
          const Eigen::Vector2d beyond = slab.local(p).cwiseAbs() - slab.half_size;
          return std::abs(beyond.maxCoeff()) < 0.015;
        });
    if (near_edge) continue;
    EXPECT_NEAR(compiled.height(p), terrain.top_at(p).value_or(-terrain.pit_depth), kRayAccuracy)
        << p.transpose();
    on_slabs += terrain.top_at(p) ? 1 : 0;
  }
  EXPECT_GT(on_slabs, 200);
}

TEST(TerrainXml, EachSlabHasItsOwnFriction) {
  const CompiledTerrain compiled(varied_terrain());
  const auto friction = [&](const std::string& name) {
    return compiled.model->geom_friction[3 * element_id(*compiled.model, mjOBJ_GEOM, name)];
  };
  EXPECT_DOUBLE_EQ(friction("slab0.top"), 0.6);
  EXPECT_DOUBLE_EQ(friction("slab3.top"), 0.3);
  EXPECT_DOUBLE_EQ(friction("slab3.base"), 0.3);
}

TEST(TerrainXml, ASlopedSlabJustAboveThePitNeedsNoBase) {
  Terrain terrain;
  terrain.pit_depth = 0.05;
  terrain.slabs = {slab_at(0.0, 0.0, 0.0)};
  terrain.slabs[0].slope = 0.1;
  const CompiledTerrain compiled(terrain);
  EXPECT_NEAR(compiled.height({0.1, 0.0}), terrain.slabs[0].height({0.1, 0.0}), 1e-9);
  EXPECT_EQ(mj_name2id(compiled.model.get(), mjOBJ_GEOM, "slab0.base"), -1);
}

TEST(SeenTerrainMap, HasTheTopAtEveryCellCentreAndThePitElsewhere) {
  const Terrain terrain = varied_terrain();
  const core::TerrainMap map = seen_terrain_map(terrain, {1.03, -0.2}, core::Stamp{7});
  EXPECT_EQ(map.stamp.nanoseconds, 7);
  EXPECT_EQ(map.cells.size(), static_cast<std::size_t>(map.size_x * map.size_y));
  for (int iy = 0; iy < map.size_y; iy += 3) {
    for (int ix = 0; ix < map.size_x; ix += 3) {
      const Eigen::Vector2d p(map.origin_x + (ix + 0.5) * map.resolution,
                              map.origin_y + (iy + 0.5) * map.resolution);
      const core::TerrainCell& cell = map.at(ix, iy);
      EXPECT_EQ(cell.state, core::CellState::observed);
      EXPECT_FLOAT_EQ(cell.height,
                      static_cast<float>(terrain.top_at(p).value_or(-terrain.pit_depth)));
      EXPECT_EQ(cell.upper, cell.height);
    }
  }
}

TEST(SeenTerrainMap, WindowIsCentredAndItsGridDoesNotDependOnTheRobot) {
  const Terrain terrain = varied_terrain();
  for (const double x : {-3.7, 0.0, 12.345}) {
    const core::TerrainMap map = seen_terrain_map(terrain, {x, 0.4}, {});
    const double cells = map.origin_x / map.resolution;
    EXPECT_NEAR(cells, std::round(cells), 1e-6);
    EXPECT_NEAR(map.origin_x + 0.5 * map.size_x * map.resolution, x, map.resolution);
    EXPECT_NEAR(map.origin_y + 0.5 * map.size_y * map.resolution, 0.4, map.resolution);
  }
}

}  // namespace
}  // namespace hopscotch::sim
