#include "sim/sim_camera.hpp"

#include <algorithm>
#include <cmath>

#include "sim/depth_scene.hpp"

namespace hopscotch::sim {

namespace {

// Purposes of random streams; the noise of the image has its own.
constexpr std::uint64_t kFrameLoss = 0xCA01;
constexpr std::uint64_t kPixelLoss = 0xCA02;

Eigen::Isometry3d true_mounting(CameraSettings settings) {
  settings.pitch += settings.pitch_error;
  return camera_mounting(settings);
}

/// True with probability `share` [-].
bool happens(Random& random, double share) {
  return 0.5 * (random.uniform() + 1.0) < share;
}

}  // namespace

SimCamera::SimCamera(const CameraSettings& settings, const model::RobotParameters& robot,
                     const Terrain& seen, std::uint64_t seed)
    : settings_(settings),
      robot_(robot),
      faces_(terrain_faces(seen)),
      seed_(seed),
      X_BC_(camera_mounting(settings)),
      X_BC_true_(true_mounting(settings)),
      renderer_(camera_intrinsics(settings), DepthRange{}) {
  if (settings.noise == CameraNoise::d435) {
    noise_.emplace(DepthNoiseModel{}, renderer_.intrinsics(), DepthRange{}, seed);
  }
}

void SimCamera::expose(const core::RobotState& truth) {
  const core::Stamp due =
      core::Stamp::from_seconds(static_cast<double>(next_index_) / settings_.rate);
  if (truth.stamp < due) return;
  // A coarse tick or a late start may have passed several exposures: the last of them happens.
  constexpr double kHalfNanosecond = 0.5e-9;  // the stamp of a due exposure is rounded
  const double passed = std::floor((truth.stamp.seconds() + kHalfNanosecond) * settings_.rate);
  const std::int64_t index = std::max(next_index_, static_cast<std::int64_t>(passed));
  next_index_ = index + 1;
  Random random = Random::stream(seed_ + static_cast<std::uint64_t>(index), kFrameLoss);
  if (happens(random, settings_.lost_frames)) return;
  pending_.push_back({static_cast<std::uint64_t>(index), truth});
}

std::optional<SimCamera::Exposure> SimCamera::due(core::Stamp now) {
  if (pending_.empty()) return std::nullopt;
  if (now < pending_.front().truth.stamp.after(settings_.latency)) return std::nullopt;
  const Exposure exposure = pending_.front();
  pending_.pop_front();
  return exposure;
}

std::optional<core::DepthFrame> SimCamera::poll(core::Stamp now) {
  const std::optional<Exposure> exposure = due(now);
  if (!exposure) return std::nullopt;
  return draw(*exposure);
}

core::DepthFrame SimCamera::draw(const Exposure& exposure) {
  Eigen::Isometry3d X_WB = Eigen::Isometry3d::Identity();
  X_WB.linear() = exposure.truth.R_WB;
  X_WB.translation() = exposure.truth.p_WB;
  core::DepthFrame frame{.stamp = exposure.truth.stamp.after(settings_.time_error),
                         .intrinsics = renderer_.intrinsics(),
                         .X_BC = X_BC_,
                         .depth = {}};
  const std::vector<Capsule> legs = leg_capsules(robot_, exposure.truth);
  if (noise_) {
    renderer_.render(faces_, legs, X_WB * X_BC_true_, exact_);
    noise_->apply(exposure.index, exact_, frame.depth);
  } else {
    renderer_.render(faces_, legs, X_WB * X_BC_true_, frame.depth);
  }
  if (settings_.lost_pixels > 0.0) lose_pixels(exposure.index, frame);
  return frame;
}

void SimCamera::lose_pixels(std::uint64_t index, core::DepthFrame& frame) const {
  constexpr int kBlock = 8;  // [pixel]
  Random random = Random::stream(seed_ + index, kPixelLoss);
  const int width = frame.intrinsics.width;
  const int height = frame.intrinsics.height;
  for (int top = 0; top < height; top += kBlock) {
    for (int left = 0; left < width; left += kBlock) {
      if (!happens(random, settings_.lost_pixels)) continue;
      for (int v = top; v < std::min(top + kBlock, height); ++v) {
        float* const row = frame.depth.data() + static_cast<std::ptrdiff_t>(v) * width;
        std::fill(row + left, row + std::min(left + kBlock, width), 0.0F);
      }
    }
  }
}

}  // namespace hopscotch::sim
