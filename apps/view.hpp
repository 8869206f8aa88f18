#pragma once

#include <optional>

#include "apps/following_camera.hpp"
#include "apps/lockstep_run.hpp"
#include "core/robot_state.hpp"
#include "sim/scene_window.hpp"

namespace hopscotch::apps {

/// A window that shows a run while it is simulated.
class LiveView {
 public:
  /// @throws sim::RendererUnavailable if there is no display.
  explicit LiveView(const RunRequest& request);

  /// Call at every tick; a picture is drawn when the last one is old enough.
  void show(const core::RobotState& state);
  /// The user closed the window.
  [[nodiscard]] bool closed() const { return window_.closed(); }

 private:
  sim::SceneWindow window_;
  FollowingCamera camera_;
  std::optional<core::Stamp> shown_;  ///< Stamp of the last picture.
};

}  // namespace hopscotch::apps
