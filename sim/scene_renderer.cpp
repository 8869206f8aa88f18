#include "sim/scene_renderer.hpp"

#include <algorithm>
#include <cstddef>

#include "sim/egl_context.hpp"
#include "sim/scene_stage.hpp"

namespace hopscotch::sim {

/// The members' order is that of creation: the context before what lives in it.
struct SceneRenderer::Drawing {
  Drawing(const std::string& mjcf, int wide, int high, Quality quality)
      : rectangle{0, 0, wide, high},
        egl(wide, high),
        stage(mjcf, rectangle, mjFB_OFFSCREEN, quality) {}

  mjrRect rectangle;
  EglContext egl;
  SceneStage stage;
  std::vector<std::uint8_t> bottom_up;  // OpenGL's first row is the lowest
};

SceneRenderer::SceneRenderer(const std::string& mjcf, int width, int height, Quality quality)
    : drawing_(std::make_unique<Drawing>(mjcf, width, height, quality)) {}
SceneRenderer::~SceneRenderer() = default;

void SceneRenderer::render(const core::RobotState& state, const View& view, RgbImage& image) {
  Drawing& drawing = *drawing_;
  drawing.stage.draw(state, view, drawing.rectangle);
  const std::size_t row = static_cast<std::size_t>(drawing.rectangle.width) * 3;
  const std::size_t rows = static_cast<std::size_t>(drawing.rectangle.height);
  drawing.bottom_up.resize(row * rows);
  mjr_readPixels(drawing.bottom_up.data(), nullptr, drawing.rectangle, &drawing.stage.context());
  image.width = drawing.rectangle.width;
  image.height = drawing.rectangle.height;
  image.pixels.resize(row * rows);
  for (std::size_t y = 0; y < rows; ++y) {
    std::copy_n(drawing.bottom_up.data() + (rows - 1 - y) * row, row,
                image.pixels.data() + y * row);
  }
}

}  // namespace hopscotch::sim
