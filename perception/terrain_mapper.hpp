#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string_view>

#include "core/depth_frame.hpp"
#include "core/robot_state.hpp"
#include "core/terrain_map.hpp"
#include "model/robot_parameters.hpp"
#include "perception/body_mask.hpp"
#include "perception/perception_config.hpp"
#include "perception/point_bins.hpp"

namespace hopscotch::perception {

/// What became of a frame.
enum class MapStatus : std::uint8_t {
  fused,      ///< The map took it in.
  moving,     ///< Trunk too fast: time and pose errors would smear the map.
  blind,      ///< No usable pixel.
  stale,      ///< Not newer than the newest frame in the map.
  bad_frame,  ///< Size, intrinsics or mounting pose are nonsense or do not fit together.
  bad_state,  ///< Pose or joint angles are not finite.
};

constexpr std::string_view map_status_name(MapStatus status) {
  switch (status) {
    case MapStatus::fused: return "fused";
    case MapStatus::moving: return "moving";
    case MapStatus::blind: return "blind";
    case MapStatus::stale: return "stale";
    case MapStatus::bad_frame: return "bad_frame";
    case MapStatus::bad_state: return "bad_state";
  }
  return "bad_frame";
}

/// Turns depth frames into a height map around the robot. The map is aligned with W and moves along
/// in whole cells; cells keep what was seen of them, so the ground below the robot is that which
/// was ahead of it before. Same calls, same map, bit by bit. Not real-time: a frame takes
/// milliseconds.
class TerrainMapper {
 public:
  TerrainMapper(const PerceptionConfig& config, const model::RobotParameters& robot);
  ~TerrainMapper();
  TerrainMapper(TerrainMapper&&) noexcept;
  TerrainMapper& operator=(TerrainMapper&&) noexcept;

  /// Fuses one frame; anything but `fused` leaves the map as it was.
  /// @param at_exposure  State at the frame's stamp.
  MapStatus integrate(const core::DepthFrame& frame, const core::RobotState& at_exposure);

  /// The same for a camera that no robot carries: no body in view, no limit of speed.
  MapStatus integrate(const core::DepthFrame& frame, const Eigen::Isometry3d& X_WC);

  /// Marks the ground under and right beside the soles as support at the soles' height: the camera
  /// cannot see the place where the robot stands at start-up. Call it when both feet bear load. A
  /// state that is not finite changes nothing and returns bad_state, otherwise fused.
  MapStatus anchor_support(const core::RobotState& state);

  [[nodiscard]] const core::TerrainMap& map() const;

  /// The newest fused frame without lost, doubtful and the body's own pixels; empty before it.
  /// Refers to this object.
  [[nodiscard]] const std::optional<PlacedDepth>& image() const;

 private:
  struct Memory;
  MapStatus fuse(const core::DepthFrame& frame, const BodyCapsules& body,
                 const Eigen::Isometry3d& X_WC, const Eigen::Isometry3d& X_WB);
  PerceptionConfig config_;
  model::RobotParameters robot_;
  std::unique_ptr<Memory> memory_;
};

}  // namespace hopscotch::perception
