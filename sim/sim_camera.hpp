#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "core/depth_source.hpp"
#include "core/robot_state.hpp"
#include "model/robot_parameters.hpp"
#include "sim/camera_noise.hpp"
#include "sim/camera_settings.hpp"
#include "sim/depth_renderer.hpp"
#include "sim/terrain.hpp"

namespace hopscotch::sim {

/// The depth camera on the simulated trunk. Exposure k is due k / rate after time zero and happens
/// at the first `expose` from then on, with the true state of that tick; the frame carries that
/// tick's stamp and can be polled exactly `latency` later. The image is drawn when it is polled, so
/// `expose` costs nothing worth counting. One thread, but for `draw`.
class SimCamera : public core::DepthSource {
 public:
  /// @param robot Whose legs are in view.
  /// @param seen  The terrain as perception is shown it.
  /// @param seed  Of the noise; noise of frame k depends on seed, k and the exact image only.
  SimCamera(const CameraSettings& settings, const model::RobotParameters& robot,
            const Terrain& seen, std::uint64_t seed);

  /// To be called at every tick with the true state, stamps increasing.
  void expose(const core::RobotState& truth);

  std::optional<core::DepthFrame> poll(core::Stamp now) override;

  /// poll() in two steps, for who draws on another thread.
  struct Exposure {
    std::uint64_t index = 0;
    core::RobotState truth;
  };
  /// The oldest exposure that can be polled by `now`; it is then no longer waiting.
  [[nodiscard]] std::optional<Exposure> due(core::Stamp now);
  /// Milliseconds; the frame's stamp and mounting are as the controller is told. One thread at a
  /// time, which may be another than that of the other calls.
  [[nodiscard]] core::DepthFrame draw(const Exposure& exposure);

 private:
  CameraSettings settings_;
  model::RobotParameters robot_;
  std::vector<Face> faces_;
  std::uint64_t seed_;
  Eigen::Isometry3d X_BC_;  // as the controller is told
  Eigen::Isometry3d X_BC_true_;
  DepthRenderer renderer_;
  std::optional<DepthNoise> noise_;
  std::int64_t next_index_ = 0;
  std::deque<Exposure> pending_;
  std::vector<float> exact_;  ///< Image before noise [m].

  void lose_pixels(std::uint64_t index, core::DepthFrame& frame) const;
};

}  // namespace hopscotch::sim
