#include "perception/plane_segmentation.hpp"

#include <pcl/features/normal_3d.h>
#include <pcl/point_types.h>
#include <pcl/search/kdtree.h>
#include <pcl/segmentation/region_growing.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

namespace hopscotch::perception {

namespace {

using Points = pcl::PointCloud<pcl::PointXYZ>;
using Normals = pcl::PointCloud<pcl::Normal>;

/// Voxel centroids in the order of their place, and how many points each stands for.
struct Voxels {
  Points::Ptr centroids{new Points};
  std::vector<int> counts;
};

Voxels voxels_of(const PointCloud& cloud, double size) {
  struct Keyed {
    std::int64_t key;
    std::uint32_t point;
  };
  constexpr std::int64_t kHalfSpan = 1 << 20;
  std::vector<Keyed> keyed;
  for (std::uint32_t i = 0; i < cloud.points.size(); ++i) {
    const Eigen::Vector3f& p = cloud.points[i];
    if (!(p.cwiseAbs().maxCoeff() < static_cast<float>(kHalfSpan - 1) * static_cast<float>(size))) {
      continue;  // not a number, or beyond what can be indexed
    }
    const Eigen::Vector3d cell = (p.cast<double>() / size).array().floor();
    const std::int64_t key = ((static_cast<std::int64_t>(cell.x()) + kHalfSpan) << 42) |
                             ((static_cast<std::int64_t>(cell.y()) + kHalfSpan) << 21) |
                             (static_cast<std::int64_t>(cell.z()) + kHalfSpan);
    keyed.push_back({key, i});
  }
  std::stable_sort(keyed.begin(), keyed.end(),
                   [](const Keyed& a, const Keyed& b) { return a.key < b.key; });
  Voxels voxels;
  for (std::size_t first = 0; first < keyed.size();) {
    Eigen::Vector3f sum = Eigen::Vector3f::Zero();
    std::size_t i = first;
    for (; i < keyed.size() && keyed[i].key == keyed[first].key; ++i) {
      sum += cloud.points[keyed[i].point];
    }
    const Eigen::Vector3f mean = sum / static_cast<float>(i - first);
    voxels.centroids->push_back(pcl::PointXYZ(mean.x(), mean.y(), mean.z()));
    voxels.counts.push_back(static_cast<int>(i - first));
    first = i;
  }
  return voxels;
}

Normals::Ptr normals_of(const Points::Ptr& points,
                        const pcl::search::KdTree<pcl::PointXYZ>::Ptr& tree, int neighbours) {
  pcl::NormalEstimation<pcl::PointXYZ, pcl::Normal> estimation;
  Normals::Ptr normals(new Normals);
  estimation.setInputCloud(points);
  estimation.setSearchMethod(tree);
  estimation.setKSearch(neighbours);
  estimation.compute(*normals);
  return normals;
}

/// Least-squares plane of some voxels.
PlanePatch fit(const Voxels& voxels, const std::vector<int>& members) {
  PlanePatch patch;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  const auto place = [&](int member) {
    return (*voxels.centroids)[static_cast<std::size_t>(member)].getVector3fMap().cast<double>();
  };
  for (const int member : members) {
    sum += place(member);
    patch.points += voxels.counts[static_cast<std::size_t>(member)];
  }
  patch.voxels = static_cast<int>(members.size());
  patch.centroid = sum / patch.voxels;
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
  for (const int member : members) {
    const Eigen::Vector3d d = place(member) - patch.centroid;
    scatter += d * d.transpose();
  }
  patch.scatter = scatter;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(scatter);
  patch.normal = axes.eigenvectors().col(0);
  if (patch.normal.dot(patch.centroid) > 0.0) patch.normal = -patch.normal;
  patch.offset = patch.normal.dot(patch.centroid);
  patch.residual = std::sqrt(std::max(0.0, axes.eigenvalues()(0)) / patch.voxels);
  return patch;
}

/// The plane of a grown region without its rounded rim.
PlanePatch trimmed_fit(const Voxels& voxels, std::vector<int> members) {
  constexpr int kRounds = 3;
  constexpr double kSigmas = 2.5;
  PlanePatch patch = fit(voxels, members);
  for (int round = 0; round < kRounds; ++round) {
    std::vector<int> kept;
    for (const int member : members) {
      const Eigen::Vector3d p =
          (*voxels.centroids)[static_cast<std::size_t>(member)].getVector3fMap().cast<double>();
      if (std::abs(patch.normal.dot(p) - patch.offset) <= kSigmas * patch.residual + 1e-6) {
        kept.push_back(member);
      }
    }
    if (kept.size() < 3) break;
    patch = fit(voxels, kept);
    members = std::move(kept);
  }
  return patch;
}

}  // namespace

PlaneConfig PlaneConfig::load(const core::ConfigReader& section) {
  using core::Range;
  PlaneConfig config;
  config.voxel = section.number("voxel_m", Range::closed(0.002, 0.1));
  config.neighbours = section.integer("neighbours", 6, 200);
  config.bend_max = section.number("bend_max_rad", Range::above(0.0, 0.5));
  config.curvature_max = section.number("curvature_max", Range::above(0.0, 1.0 / 3.0));
  config.voxels_min = section.integer("voxels_min", 10, 100000);
  section.finish();
  return config;
}

std::vector<PlanePatch> segment_planes(const PlaneConfig& config, const PointCloud& cloud) {
  const Voxels voxels = voxels_of(cloud, config.voxel);
  if (voxels.counts.size() < static_cast<std::size_t>(config.voxels_min)) return {};
  const pcl::search::KdTree<pcl::PointXYZ>::Ptr tree(new pcl::search::KdTree<pcl::PointXYZ>);
  tree->setInputCloud(voxels.centroids);
  pcl::RegionGrowing<pcl::PointXYZ, pcl::Normal> growing;
  growing.setInputCloud(voxels.centroids);
  growing.setInputNormals(normals_of(voxels.centroids, tree, config.neighbours));
  growing.setSearchMethod(tree);
  growing.setNumberOfNeighbours(static_cast<unsigned>(config.neighbours));
  growing.setMinClusterSize(static_cast<pcl::uindex_t>(config.voxels_min));
  growing.setSmoothnessThreshold(static_cast<float>(config.bend_max));
  growing.setCurvatureThreshold(static_cast<float>(config.curvature_max));
  std::vector<pcl::PointIndices> regions;
  growing.extract(regions);
  std::vector<PlanePatch> patches;
  for (const pcl::PointIndices& region : regions) {
    patches.push_back(trimmed_fit(voxels, region.indices));
  }
  std::stable_sort(patches.begin(), patches.end(),
                   [](const PlanePatch& a, const PlanePatch& b) { return a.voxels > b.voxels; });
  return patches;
}

}  // namespace hopscotch::perception
