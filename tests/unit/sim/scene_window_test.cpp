#include "sim/scene_window.hpp"

#include <gtest/gtest.h>

#include <cstdlib>

namespace hopscotch::sim {
namespace {

TEST(SceneWindow, WithoutADisplayThereIsAClearRefusal) {
  unsetenv("DISPLAY");
  unsetenv("WAYLAND_DISPLAY");
  try {
    const SceneWindow window("<mujoco/>", "none");
    FAIL() << "a window without a display";
  } catch (const RendererUnavailable& lack) {
    EXPECT_NE(std::string(lack.what()).find("no window"), std::string::npos) << lack.what();
  }
}

}  // namespace
}  // namespace hopscotch::sim
