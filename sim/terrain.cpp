#include "sim/terrain.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace hopscotch::sim {
namespace {

constexpr double kTouch = 1e-9;  // [m] slabs this close share a border and do not overlap

Eigen::Vector2d axis_x(const Slab& slab) {
  return {std::cos(slab.yaw), std::sin(slab.yaw)};
}

Eigen::Vector2d axis_y(const Slab& slab) {
  return {-std::sin(slab.yaw), std::cos(slab.yaw)};
}

/// Half of the extent of the outline along a unit vector [m].
double half_extent(const Slab& slab, const Eigen::Vector2d& along) {
  return slab.half_size.x() * std::abs(axis_x(slab).dot(along)) +
         slab.half_size.y() * std::abs(axis_y(slab).dot(along));
}

bool separated_along(const Slab& a, const Slab& b, const Eigen::Vector2d& axis) {
  const double distance = std::abs((b.centre - a.centre).dot(axis));
  return distance >= half_extent(a, axis) + half_extent(b, axis) - kTouch;
}

/// Distance along a ray at which it leaves a slab's outline [m]; the ray starts inside.
double exit_distance(const Slab& slab, const Eigen::Vector2d& from,
                     const Eigen::Vector2d& direction) {
  const Eigen::Vector2d start = slab.local(from);
  const Eigen::Vector2d step = slab.local(from + direction) - start;
  double nearest = std::numeric_limits<double>::infinity();
  for (int i = 0; i < 2; ++i) {
    if (std::abs(step[i]) < kTouch) continue;
    const double border = std::copysign(slab.half_size[i], step[i]);
    nearest = std::min(nearest, (border - start[i]) / step[i]);
  }
  return std::max(nearest, 0.0);
}

}  // namespace

Eigen::Vector2d Slab::local(const Eigen::Vector2d& p_W) const {
  const Eigen::Vector2d offset = p_W - centre;
  return {offset.dot(axis_x(*this)), offset.dot(axis_y(*this))};
}

bool Slab::contains(const Eigen::Vector2d& p_W) const {
  const Eigen::Vector2d p = local(p_W);
  return std::abs(p.x()) <= half_size.x() + kTouch && std::abs(p.y()) <= half_size.y() + kTouch;
}

double Slab::height(const Eigen::Vector2d& p_W) const {
  return top + std::tan(slope) * (local(p_W).x() + half_size.x());
}

std::array<Eigen::Vector3d, 4> Slab::top_corners() const {
  constexpr std::array<std::pair<double, double>, 4> kSigns{
      {{-1.0, -1.0}, {1.0, -1.0}, {1.0, 1.0}, {-1.0, 1.0}}};
  std::array<Eigen::Vector3d, 4> corners;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Eigen::Vector2d p = centre + kSigns[i].first * half_size.x() * axis_x(*this) +
                              kSigns[i].second * half_size.y() * axis_y(*this);
    corners[i] = {p.x(), p.y(), height(p)};
  }
  return corners;
}

double Slab::lowest() const {
  return top + std::min(0.0, 2.0 * half_size.x() * std::tan(slope));
}

double Slab::highest() const {
  return top + std::max(0.0, 2.0 * half_size.x() * std::tan(slope));
}

Terrain moved(const Terrain& terrain, const Eigen::Vector2d& pivot, double yaw,
              const Eigen::Vector3d& shift) {
  Terrain result = terrain;
  result.pit_depth -= shift.z();
  for (Slab& slab : result.slabs) {
    slab.centre = pivot + Eigen::Rotation2Dd(yaw) * (slab.centre - pivot) + shift.head<2>();
    slab.yaw += yaw;
    slab.top += shift.z();
  }
  return result;
}

bool overlap(const Slab& a, const Slab& b) {
  for (const Slab* slab : {&a, &b}) {
    if (separated_along(a, b, axis_x(*slab)) || separated_along(a, b, axis_y(*slab))) return false;
  }
  return true;
}

std::optional<std::size_t> Terrain::slab_at(const Eigen::Vector2d& p_W) const {
  for (std::size_t i = 0; i < slabs.size(); ++i) {
    if (slabs[i].contains(p_W)) return i;
  }
  return std::nullopt;
}

std::optional<double> Terrain::top_at(const Eigen::Vector2d& p_W) const {
  const std::optional<std::size_t> slab = slab_at(p_W);
  if (!slab) return std::nullopt;
  return slabs[*slab].height(p_W);
}

std::optional<double> support_ahead(const Terrain& terrain, const Eigen::Vector2d& from,
                                    const Eigen::Vector2d& direction) {
  constexpr double kProbe = 1e-6;  // [m] steps over a shared border
  std::optional<std::size_t> slab = terrain.slab_at(from);
  if (!slab) return std::nullopt;
  double distance = 0.0;
  // Each slab is left for good (it is convex), so there are at most as many as the terrain has.
  for (std::size_t crossed = 0; crossed < terrain.slabs.size(); ++crossed) {
    distance += exit_distance(terrain.slabs[*slab], from + distance * direction, direction);
    const Eigen::Vector2d border = from + distance * direction;
    const std::optional<std::size_t> next = terrain.slab_at(border + kProbe * direction);
    if (!next || *next == *slab) break;
    const double step = terrain.slabs[*next].height(border) - terrain.slabs[*slab].height(border);
    if (std::abs(step) > kLevelJoint) break;
    slab = next;
  }
  return distance;
}

}  // namespace hopscotch::sim
