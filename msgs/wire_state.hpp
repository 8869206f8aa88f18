#pragma once

#include "core/robot_state.hpp"
#include "hopscotch_msgs/robot_state.hpp"

/// The part that HOP_STATE and HOP_TRUTH share. Private to this folder.
namespace hopscotch::msgs::wire {

/// All but the header.
void put(const core::RobotState& from, hopscotch_msgs::robot_state& to);
void get(const hopscotch_msgs::robot_state& from, core::RobotState& to);

}  // namespace hopscotch::msgs::wire
