#pragma once

#include <mujoco/mujoco.h>

#include <string>

#include "core/robot_state.hpp"
#include "sim/mujoco_model.hpp"
#include "sim/scene_renderer.hpp"

namespace hopscotch::sim {

/// The simulated world with what MuJoCo needs to draw it. Needs a current OpenGL context for as
/// long as it lives. For the drawing classes of this folder.
class SceneStage {
 public:
  /// @param size   Largest picture [pixel].
  /// @param buffer mjFB_OFFSCREEN or mjFB_WINDOW.
  /// @throws std::runtime_error if MuJoCo refuses the document.
  SceneStage(const std::string& mjcf, const mjrRect& size, mjtFramebuffer buffer, Quality quality);
  ~SceneStage();
  SceneStage(const SceneStage&) = delete;
  SceneStage& operator=(const SceneStage&) = delete;

  /// Draws into the current buffer.
  void draw(const core::RobotState& state, const View& view, const mjrRect& rectangle);
  [[nodiscard]] const mjrContext& context() const { return context_; }

 private:
  void pose(const core::RobotState& state);
  void aim(const View& view);

  ModelPointer model_;
  DataPointer data_;
  mjvScene scene_{};
  mjvOption option_{};
  mjvCamera camera_{};
  mjrContext context_{};
};

}  // namespace hopscotch::sim
