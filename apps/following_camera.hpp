#pragma once

#include <Eigen/Core>

#include "core/robot_state.hpp"
#include "sim/scene_renderer.hpp"

namespace hopscotch::apps {

/// Direction of view along y of W [rad]: x of W runs to the right.
inline constexpr double kSideways = 1.5707963267948966;

/// The camera that goes along with the robot: from the side, a little ahead and above. Its own
/// motion is smooth, so that the jumps are seen as such.
class FollowingCamera {
 public:
  /// @param dt Since the previous picture [s]; the first one may pass 0.
  sim::View view(const core::RobotState& state, double dt);

 private:
  Eigen::Vector3d middle_ = Eigen::Vector3d::Zero();
  bool started_ = false;
};

}  // namespace hopscotch::apps
