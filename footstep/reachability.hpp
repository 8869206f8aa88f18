#pragma once

#include "core/reason.hpp"
#include "footstep/footstep_config.hpp"

namespace hopscotch::footstep {

/// What the robot can do for one change of height.
struct Reach {
  double distance_min = 0.0;      ///< [m]
  double distance_max = 0.0;      ///< [m]
  double takeoff_edge_max = 0.0;  ///< [m]
  double past_edge_min = 0.0;     ///< Of a landing after a drop [m].
};

/// The table at `height` [m], linear between its rows, the end rows beyond them.
[[nodiscard]] Reach reach_at(const ReachConfig& config, double height);

/// One jump in numbers.
struct Leap {
  double distance = 0.0;      ///< Mid-point to mid-point of the soles [m].
  double height = 0.0;        ///< Landing above takeoff [m].
  double takeoff_edge = 0.0;  ///< Takeoff tread ends so far ahead of its soles' mid-point [m].
};

/// `none` when the robot can do it, otherwise step_too_high, step_too_low or out_of_reach. A drop
/// from too far behind the edge is out of reach, and one that ends too near below it: knees and
/// shanks, which lean back while the landing sinks, would hit the edge.
[[nodiscard]] core::Reason reach_verdict(const ReachConfig& config, const Leap& leap);

/// Longest distance of the whole table [m].
[[nodiscard]] double longest_reach(const ReachConfig& config);
/// Shortest distance of the whole table [m].
[[nodiscard]] double shortest_reach(const ReachConfig& config);

}  // namespace hopscotch::footstep
