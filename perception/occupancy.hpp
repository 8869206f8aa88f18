#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "core/time.hpp"
#include "perception/perception_config.hpp"
#include "perception/point_bins.hpp"

namespace hopscotch::perception {

/// What the volume around the robot holds, as voxels: what hangs where the robot is going to fly.
/// Heights of ground come from TerrainMapper, which is finer by far. Same calls, same answers. Not
/// real-time: a frame takes milliseconds.
class OccupancyMemory {
 public:
  explicit OccupancyMemory(const OccupancyConfig& config);
  ~OccupancyMemory();
  OccupancyMemory(OccupancyMemory&&) noexcept;
  OccupancyMemory& operator=(OccupancyMemory&&) noexcept;

  /// Takes in an image that lost and masked pixels have left: rays clear what they pass through and
  /// end in what is there. What is far from the camera is forgotten. @return false if the image is
  /// not at least a period newer than the one before; nothing changed then.
  bool insert(const PlacedDepth& image, core::Stamp stamp);

  /// Bottoms of occupied voxels below which the camera has looked through, in W [m]: neither ground
  /// nor anything that stands on it. The near edges of treads are among them.
  [[nodiscard]] std::vector<Eigen::Vector3f> hanging() const;

  enum class Voxel : std::uint8_t { unknown, free, occupied };
  /// Of the voxel at a place in W [m].
  [[nodiscard]] Voxel at(const Eigen::Vector3f& p_W) const;

  [[nodiscard]] std::size_t voxels() const;

 private:
  struct Memory;
  OccupancyConfig config_;
  std::unique_ptr<Memory> memory_;
};

}  // namespace hopscotch::perception
