#pragma once

#include <memory>
#include <string>

#include "core/robot_state.hpp"
#include "sim/scene_renderer.hpp"

namespace hopscotch::sim {

/// Shows the simulated world in a window. Dragging turns the view, the wheel moves it nearer. One
/// thread: the main one.
class SceneWindow {
 public:
  /// @param mjcf Document as of `scene_mjcf`.
  /// @throws RendererUnavailable if there is no display or no OpenGL on it;
  ///         std::runtime_error if MuJoCo refuses the document.
  SceneWindow(const std::string& mjcf, const std::string& title);
  ~SceneWindow();
  SceneWindow(const SceneWindow&) = delete;
  SceneWindow& operator=(const SceneWindow&) = delete;

  /// Draws one picture and takes in what the user did with the mouse.
  void show(const core::RobotState& state, const View& view);
  /// The user closed the window.
  [[nodiscard]] bool closed() const;

 private:
  struct Window;
  std::unique_ptr<Window> window_;
};

}  // namespace hopscotch::sim
