#include "perception/sight_lines.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "perception/map_window.hpp"
#include "tests/unit/perception/synthetic_terrain.hpp"

namespace hopscotch::perception {
namespace {

TEST(SightLines, ListsTheCellsBetweenWithTheHeightOfTheRay) {
  const MapWindow window = empty_window(test::perception_config().mapper, {0.0, 0.0});
  const Eigen::Vector3d camera(0.0, 0.1, 0.6);
  const SightLine line{.near = {0.5F, 0.0F, -0.6F}, .far = {1.0F, 0.0F, -0.9F}};
  std::vector<CellUnderRay> cells;
  cells_under_ray(window.map, camera, line, cells);
  ASSERT_FALSE(cells.empty());
  std::set<std::size_t> once;
  const std::size_t size_x = static_cast<std::size_t>(window.map.size_x);
  for (const CellUnderRay& under : cells) {
    EXPECT_TRUE(once.insert(under.cell).second);
    const double x = window.map.origin_x +
                     (static_cast<double>(under.cell % size_x) + 0.5) * window.map.resolution;
    EXPECT_GT(x, 0.5);
    EXPECT_LT(x, 1.0);
    const double ray_over_centre = 0.6 - 0.9 * x;
    EXPECT_GE(under.ray_height, ray_over_centre - 1e-6) << "an upper bound for the whole cell";
    EXPECT_LE(under.ray_height, ray_over_centre + 0.9 * 1.5 * window.map.resolution);
  }
  const double cells_between = 0.5 / window.map.resolution - 1.5;  // less the zones at both ends
  EXPECT_NEAR(static_cast<double>(cells.size()), cells_between, 2.0);
}

TEST(SightLines, NeighbouringPointsHideNothing) {
  const MapWindow window = empty_window(test::perception_config().mapper, {0.0, 0.0});
  const SightLine line{.near = {0.5F, 0.0F, -0.6F}, .far = {0.514F, 0.0F, -0.6F}};
  std::vector<CellUnderRay> cells{{1, 2.0F}};
  cells_under_ray(window.map, {0.0, 0.0, 0.6}, line, cells);
  EXPECT_TRUE(cells.empty());
}

}  // namespace
}  // namespace hopscotch::perception
