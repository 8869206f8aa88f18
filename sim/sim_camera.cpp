#include "sim/sim_camera.hpp"

#include <algorithm>
#include <cmath>

#include "sim/depth_scene.hpp"

namespace hopscotch::sim {

SimCamera::SimCamera(const CameraSettings& settings, const model::RobotParameters& robot,
                     const Terrain& seen, std::uint64_t seed)
    : settings_(settings),
      robot_(robot),
      faces_(terrain_faces(seen)),
      X_BC_(camera_mounting(settings)),
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
  pending_.push_back({static_cast<std::uint64_t>(index), truth});
  next_index_ = index + 1;
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
  core::DepthFrame frame{.stamp = exposure.truth.stamp,
                         .intrinsics = renderer_.intrinsics(),
                         .X_BC = X_BC_,
                         .depth = {}};
  const std::vector<Capsule> legs = leg_capsules(robot_, exposure.truth);
  if (noise_) {
    renderer_.render(faces_, legs, X_WB * X_BC_, exact_);
    noise_->apply(exposure.index, exact_, frame.depth);
  } else {
    renderer_.render(faces_, legs, X_WB * X_BC_, frame.depth);
  }
  return frame;
}

}  // namespace hopscotch::sim
