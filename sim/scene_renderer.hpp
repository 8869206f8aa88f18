#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "core/robot_state.hpp"

namespace hopscotch::sim {

/// This machine cannot draw without a screen; the text says what is missing.
class RendererUnavailable : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A colour picture, row by row from the top, three bytes (red, green, blue) per pixel.
struct RgbImage {
  int width = 0;   ///< [pixel]
  int height = 0;  ///< [pixel]
  std::vector<std::uint8_t> pixels;
};

enum class Shadows : std::uint8_t { drawn, omitted };

/// From where the picture is taken, and how.
struct View {
  Eigen::Vector3d target =
      Eigen::Vector3d::Zero();  ///< Point in the middle of the picture, in W [m].
  double distance = 3.0;        ///< Of the eye from it [m].
  double azimuth = 0.0;         ///< Direction of view in the plane; 0 along x, pi/2 along y [rad].
  double elevation = 0.0;       ///< Of the direction of view; negative looks down [rad].
  double field_of_view = 0.7;   ///< From the lower to the upper border of the picture [rad].
  Shadows shadows = Shadows::drawn;
};

/// What a picture may cost.
enum class Quality : std::uint8_t {
  film,   ///< One sample per pixel: for many pictures.
  still,  ///< Smooth edges; two to three times the time.
};

/// Draws the simulated world for people, off screen (EGL without a surface, no display needed),
/// from recorded states, so that a run is never slowed by its pictures. One thread: that of
/// construction.
class SceneRenderer {
 public:
  /// @param mjcf Document as of `scene_mjcf`.
  /// @throws RendererUnavailable if the machine has no EGL or no OpenGL context;
  ///         std::runtime_error if MuJoCo refuses the document.
  SceneRenderer(const std::string& mjcf, int width, int height, Quality quality);
  ~SceneRenderer();
  SceneRenderer(const SceneRenderer&) = delete;
  SceneRenderer& operator=(const SceneRenderer&) = delete;

  /// @param[out] image Resized as needed.
  void render(const core::RobotState& state, const View& view, RgbImage& image);

 private:
  struct Drawing;
  std::unique_ptr<Drawing> drawing_;
};

}  // namespace hopscotch::sim
