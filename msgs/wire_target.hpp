#pragma once

#include "core/landing_target.hpp"
#include "core/one_step_terrain.hpp"
#include "hopscotch_msgs/landing_target.hpp"
#include "hopscotch_msgs/profile.hpp"

/// Parts that HOP_TERRAIN, HOP_TARGET and HOP_PLAN share. Private to this folder.
namespace hopscotch::msgs::wire {

void put(const core::TerrainProfile& from, hopscotch_msgs::profile& to);
[[nodiscard]] bool get(const hopscotch_msgs::profile& from, core::TerrainProfile& to);

void put(const core::LandingTarget& from, hopscotch_msgs::landing_target& to);
[[nodiscard]] bool get(const hopscotch_msgs::landing_target& from, core::LandingTarget& to);

}  // namespace hopscotch::msgs::wire
