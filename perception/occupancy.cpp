#include "perception/occupancy.hpp"

#include <octomap/octomap.h>

#include <algorithm>
#include <optional>

namespace hopscotch::perception {

namespace {

/// So many free voxels below make an occupied one hang.
constexpr int kLookedThrough = 3;

octomap::point3d as_point(const Eigen::Vector3f& p) {
  return {p.x(), p.y(), p.z()};
}

OccupancyMemory::Voxel state_of(const octomap::OcTree& tree, const octomap::OcTreeNode* node) {
  if (node == nullptr) return OccupancyMemory::Voxel::unknown;
  if (tree.isNodeOccupied(node)) return OccupancyMemory::Voxel::occupied;
  // Between free and occupied something was seen once, or has just gone.
  return node->getLogOdds() < 0.0F ? OccupancyMemory::Voxel::free : OccupancyMemory::Voxel::unknown;
}

/// @param wide_step  For images 640 pixels wide; smaller ones are used in proportion.
octomap::Pointcloud cloud_of(const PlacedDepth& image, int wide_step) {
  const core::CameraIntrinsics& lens = image.intrinsics;
  constexpr int kWidth = 640;
  const int step = std::max(1, wide_step * lens.width / kWidth);
  const Eigen::Isometry3f X_WC = image.X_WC.cast<float>();
  octomap::Pointcloud cloud;
  for (int v = step / 2; v < lens.height; v += step) {
    for (int u = step / 2; u < lens.width; u += step) {
      const float z = image.depth[static_cast<std::size_t>(v * lens.width + u)];
      if (!(z > 0.0F)) continue;  // what was not measured clears nothing
      const Eigen::Vector3d ray((u - lens.cx) / lens.fx, (v - lens.cy) / lens.fy, 1.0);
      cloud.push_back(as_point(X_WC * (z * ray.cast<float>())));
    }
  }
  return cloud;
}

}  // namespace

struct OccupancyMemory::Memory {
  explicit Memory(const OccupancyConfig& config) : tree(config.voxel) {
    tree.setProbHit(config.hit);
    tree.setProbMiss(config.miss);
    tree.setOccupancyThres(config.occupied);
    tree.setClampingThresMin(config.clamp_low);
    tree.setClampingThresMax(config.clamp_high);
    tree.useBBXLimit(true);
  }

  /// A walk over the whole tree, so not for each frame. What stays is copied: OctoMap 1.9.7 stops
  /// the program when the last child of a node is deleted.
  void forget_outside() {
    octomap::OcTree kept(tree.getResolution());
    kept.setClampingThresMin(tree.getClampingThresMin());
    kept.setClampingThresMax(tree.getClampingThresMax());
    constexpr bool kLazy = true;
    tree.expand();
    for (auto leaf = tree.begin_leafs(); leaf != tree.end_leafs(); ++leaf) {
      if (tree.inBBX(leaf.getKey())) kept.setNodeValue(leaf.getKey(), leaf->getLogOdds(), kLazy);
    }
    kept.updateInnerOccupancy();
    kept.prune();
    tree.swapContent(kept);
  }

  octomap::OcTree tree;
  std::optional<core::Stamp> newest;
};

OccupancyMemory::OccupancyMemory(const OccupancyConfig& config)
    : config_(config), memory_(std::make_unique<Memory>(config)) {}
OccupancyMemory::~OccupancyMemory() = default;
OccupancyMemory::OccupancyMemory(OccupancyMemory&&) noexcept = default;
OccupancyMemory& OccupancyMemory::operator=(OccupancyMemory&&) noexcept = default;

bool OccupancyMemory::insert(const PlacedDepth& image, core::Stamp stamp) {
  Memory& memory = *memory_;
  // Frames come with a little jitter.
  constexpr double kJitter = 0.005;  // [s]
  if (memory.newest && stamp.since(*memory.newest) < config_.period - kJitter) return false;
  memory.newest = stamp;
  const Eigen::Vector3f camera = image.X_WC.translation().cast<float>();
  const Eigen::Vector3f reach =
      Eigen::Vector3d(config_.reach, config_.reach, config_.half_height).cast<float>();
  octomap::point3d low = as_point(camera - reach);  // the library wants variables
  octomap::point3d high = as_point(camera + reach);
  memory.tree.setBBXMin(low);
  memory.tree.setBBXMax(high);
  constexpr double kNoLimit = -1.0;
  constexpr bool kLazy = false;
  constexpr bool kDiscretize = true;
  memory.tree.insertPointCloud(cloud_of(image, config_.pixel_step), as_point(camera), kNoLimit,
                               kLazy, kDiscretize);
  if (memory.tree.size() > static_cast<std::size_t>(config_.nodes_max)) memory.forget_outside();
  return true;
}

std::vector<Eigen::Vector3f> OccupancyMemory::hanging() const {
  const octomap::OcTree& tree = memory_->tree;
  const auto edge = static_cast<float>(config_.voxel);
  std::vector<Eigen::Vector3f> bottoms;
  for (auto leaf = tree.begin_leafs(); leaf != tree.end_leafs(); ++leaf) {
    if (!tree.isNodeOccupied(*leaf)) continue;
    const octomap::point3d centre = leaf.getCoordinate();
    const float bottom = centre.z() - 0.5F * static_cast<float>(leaf.getSize());
    bool hangs = true;
    for (int i = 0; i < kLookedThrough && hangs; ++i) {
      const octomap::point3d below(centre.x(), centre.y(),
                                   bottom - (static_cast<float>(i) + 0.5F) * edge);
      hangs = state_of(tree, tree.search(below)) == Voxel::free;
    }
    if (hangs) bottoms.emplace_back(centre.x(), centre.y(), bottom);
  }
  return bottoms;
}

OccupancyMemory::Voxel OccupancyMemory::at(const Eigen::Vector3f& p_W) const {
  return state_of(memory_->tree, memory_->tree.search(as_point(p_W)));
}

std::size_t OccupancyMemory::voxels() const {
  return memory_->tree.size();
}

}  // namespace hopscotch::perception
