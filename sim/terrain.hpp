#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <optional>
#include <vector>

namespace hopscotch::sim {

/// A block one can stand on. Its outline in the plane is a rectangle turned by `yaw` about its
/// centre; its top rises along the rectangle's own x axis. Frame: W = the scenario's frame.
struct Slab {
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();     ///< Of the outline, in W [m].
  Eigen::Vector2d half_size = Eigen::Vector2d::Zero();  ///< Half length along x, half width [m].
  double top = 0.0;       ///< Height of the near edge (its own -x end), in W [m].
  double slope = 0.0;     ///< Rise of the top along its own x [rad].
  double yaw = 0.0;       ///< [rad]
  double friction = 0.6;  ///< Sole on this slab [-].

  /// A point of W in the slab's own axes, from its centre [m].
  [[nodiscard]] Eigen::Vector2d local(const Eigen::Vector2d& p_W) const;
  /// The outline contains the point; its border counts as inside.
  [[nodiscard]] bool contains(const Eigen::Vector2d& p_W) const;
  /// Height of the (extended) top plane above a point of the plane, in W [m].
  [[nodiscard]] double height(const Eigen::Vector2d& p_W) const;
  /// Corners of the top, counter-clockwise seen from above, starting at the near right one [m].
  [[nodiscard]] std::array<Eigen::Vector3d, 4> top_corners() const;
  [[nodiscard]] double lowest() const;   ///< Lowest point of the top, in W [m].
  [[nodiscard]] double highest() const;  ///< Highest point of the top, in W [m].
};

/// The outlines share area; a common border does not count. Separating axis test.
[[nodiscard]] bool overlap(const Slab& a, const Slab& b);

/// Slabs over a pit. What lies between slabs is `pit_depth` below z = 0 of W.
struct Terrain {
  std::vector<Slab> slabs;
  double pit_depth = 0.5;  ///< [m]

  /// The slab under (or over) a point of the plane.
  [[nodiscard]] std::optional<std::size_t> slab_at(const Eigen::Vector2d& p_W) const;
  /// Height of the slab top there, in W [m]; nothing over the pit.
  [[nodiscard]] std::optional<double> top_at(const Eigen::Vector2d& p_W) const;
};

/// The terrain turned by `yaw` [rad] about the vertical through `pivot` and then shifted [m]: how
/// it lies around someone whose belief of place and heading is off by that.
[[nodiscard]] Terrain moved(const Terrain& terrain, const Eigen::Vector2d& pivot, double yaw,
                            const Eigen::Vector3d& shift);

/// How far a point on a slab is from where support ends in one direction.
/// @param from       A supported point of the plane, in W [m].
/// @param direction  Unit vector in the plane of W.
/// @return Distance to the last support in that direction [m]: slabs that join with less than
///         `kLevelJoint` of height difference count as one. Nothing if `from` is not supported.
[[nodiscard]] std::optional<double> support_ahead(const Terrain& terrain,
                                                  const Eigen::Vector2d& from,
                                                  const Eigen::Vector2d& direction);

/// Step between touching slabs that a sole bridges without rocking [m].
inline constexpr double kLevelJoint = 0.005;

}  // namespace hopscotch::sim
