#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/config_reader.hpp"
#include "perception/point_cloud.hpp"

namespace hopscotch::perception {

/// How planes are found in a recording; section `perception.planes`.
struct PlaneConfig {
  double voxel = 0.0;          ///< Points within one are taken together [m].
  int neighbours = 0;          ///< A normal is fitted to so many voxels.
  double bend_max = 0.0;       ///< Normals of neighbours on one plane differ by less [rad].
  double curvature_max = 0.0;  ///< Share of a neighbourhood's scatter that is across its plane.
  int voxels_min = 0;          ///< Smaller patches are no planes.

  static PlaneConfig load(const core::ConfigReader& section);
};

/// A flat piece of a recording: normal . p = offset.
struct PlanePatch {
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();   ///< Towards the sensor at the origin.
  double offset = 0.0;                                 ///< [m]
  Eigen::Vector3d centroid = Eigen::Vector3d::Zero();  ///< [m]
  int voxels = 0;                                      ///< A measure of its area.
  int points = 0;                                      ///< Measured on it.
  double residual = 0.0;  ///< Standard deviation of its voxels about it [m].
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();  ///< Of its voxels about the centroid [m^2].
};

/// Grows planes over the cloud (PCL normals and region growing), largest first. For single
/// recordings: it takes a fraction of a second.
[[nodiscard]] std::vector<PlanePatch> segment_planes(const PlaneConfig& config,
                                                     const PointCloud& cloud);

}  // namespace hopscotch::perception
