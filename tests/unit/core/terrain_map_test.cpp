#include "core/terrain_map.hpp"

#include <gtest/gtest.h>

namespace hopscotch::core {
namespace {

TerrainMap small_map() {
  TerrainMap map;
  map.size_x = 3;
  map.size_y = 2;
  map.resolution = 0.1;
  map.cells.resize(6);
  return map;
}

TEST(TerrainMap, ContainsExactlyItsCells) {
  const TerrainMap map = small_map();
  EXPECT_TRUE(map.contains(0, 0));
  EXPECT_TRUE(map.contains(2, 1));
  EXPECT_FALSE(map.contains(3, 0));
  EXPECT_FALSE(map.contains(0, 2));
  EXPECT_FALSE(map.contains(-1, 0));
  EXPECT_FALSE(map.contains(0, -1));
}

TEST(TerrainMap, CellsLieRowByRowAlongX) {
  TerrainMap map = small_map();
  map.at(2, 1).height = 0.7F;
  EXPECT_EQ(map.cells[5].height, 0.7F);
  map.cells[1].height = 0.3F;
  const TerrainMap& read_only = map;
  EXPECT_EQ(read_only.at(1, 0).height, 0.3F);
}

TEST(TerrainMap, NewMapContainsNothing) {
  EXPECT_FALSE(TerrainMap().contains(0, 0));
}

}  // namespace
}  // namespace hopscotch::core
