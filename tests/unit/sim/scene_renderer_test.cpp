#include "sim/scene_renderer.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <numbers>
#include <optional>

#include "model/robot_parameters.hpp"
#include "sim/scene_builder.hpp"
#include "sim/terrain.hpp"

namespace hopscotch::sim {
namespace {

constexpr int kWidth = 160;
constexpr int kHeight = 90;

std::string scene() {
  Terrain terrain;
  terrain.slabs.push_back({.centre = {0.0, 0.0}, .half_size = {1.0, 0.6}});
  return scene_mjcf(model::RobotParameters::load(HOPSCOTCH_SOURCE_DIR "/config/robots/hector.yaml"),
                    terrain);
}

core::RobotState standing(double x) {
  core::RobotState state;
  state.p_WB << x, 0.0, 0.5481;
  state.R_WB.setIdentity();
  state.q << 0.0, 0.0, 0.785, -1.571, 0.786, 0.0, 0.0, 0.785, -1.571, 0.786;
  return state;
}

View from_the_side() {
  return {.target = {0.0, 0.0, 0.4}, .distance = 2.0, .azimuth = 0.5 * std::numbers::pi};
}

/// Pixels of one half of the picture in which two pictures differ clearly.
int changed_pixels(const RgbImage& a, const RgbImage& b, int first_column, int last_column) {
  constexpr int kClearly = 40;  // of 255
  int count = 0;
  for (int y = 0; y < a.height; ++y) {
    for (int x = first_column; x < last_column; ++x) {
      const auto at = static_cast<std::size_t>(3 * (y * a.width + x));
      count += std::abs(int{a.pixels[at]} - int{b.pixels[at]}) > kClearly ? 1 : 0;
    }
  }
  return count;
}

class SceneRendering : public testing::Test {
 protected:
  void SetUp() override {
    try {
      renderer_.emplace(scene(), kWidth, kHeight, Quality::film);
    } catch (const RendererUnavailable& lack) {
      GTEST_SKIP() << lack.what();
    }
  }
  RgbImage picture(const core::RobotState& state, const View& view) {
    RgbImage image;
    renderer_->render(state, view, image);
    return image;
  }

  std::optional<SceneRenderer> renderer_;
};

TEST_F(SceneRendering, PictureHasTheSizeAskedFor) {
  const RgbImage image = picture(standing(0.0), from_the_side());
  EXPECT_EQ(image.width, kWidth);
  EXPECT_EQ(image.height, kHeight);
  EXPECT_EQ(image.pixels.size(), static_cast<std::size_t>(3 * kWidth * kHeight));
}

TEST_F(SceneRendering, RobotIsSeenWhereItIsAndTowardsXIsRight) {
  constexpr double kOutOfSight = 100.0;
  const RgbImage empty = picture(standing(kOutOfSight), from_the_side());
  const RgbImage right = picture(standing(0.6), from_the_side());
  const int in_left_half = changed_pixels(right, empty, 0, kWidth / 2);
  const int in_right_half = changed_pixels(right, empty, kWidth / 2, kWidth);
  EXPECT_GT(in_right_half, 100);
  EXPECT_LT(in_left_half, in_right_half / 4);  // a shadow may reach over
}

TEST_F(SceneRendering, SkyIsAboveTheGround) {
  const RgbImage image = picture(standing(0.0), from_the_side());
  const auto brightness = [&](int row) {
    return int{image.pixels[static_cast<std::size_t>(3 * row * kWidth)]} +
           int{image.pixels[static_cast<std::size_t>(3 * row * kWidth) + 2]};
  };
  EXPECT_GT(brightness(0), brightness(kHeight - 1)) << "the picture stands on its head";
}

TEST_F(SceneRendering, SameStateGivesTheSamePicture) {
  EXPECT_EQ(picture(standing(0.1), from_the_side()).pixels,
            picture(standing(0.1), from_the_side()).pixels);
}

TEST_F(SceneRendering, ShadowsCanBeLeftOut) {
  View shadowless = from_the_side();
  shadowless.elevation = -0.5;
  View with = shadowless;
  shadowless.shadows = Shadows::omitted;
  EXPECT_GT(
      changed_pixels(picture(standing(0.0), with), picture(standing(0.0), shadowless), 0, kWidth),
      20);
}

TEST_F(SceneRendering, TwoRenderersTakeTurns) {
  const RgbImage alone = picture(standing(0.0), from_the_side());
  renderer_.reset();
  SetUp();
  EXPECT_EQ(picture(standing(0.0), from_the_side()).pixels, alone.pixels);
}

}  // namespace
}  // namespace hopscotch::sim
