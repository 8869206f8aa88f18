#include "perception/ground_frame.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace hopscotch::perception {

namespace {

using Eigen::Vector3d;

constexpr double kDegree = std::numbers::pi / 180.0;
/// A camera on a robot looks down by less than this, so the floor's normal is about -y of C.
constexpr double kCameraTilt = 65.0 * kDegree;
/// An axis named as up may be off by this.
constexpr double kAxisError = 6.0 * kDegree;
/// Floors of several levels are parallel within this.
constexpr double kParallel = 5.0 * kDegree;
/// A lower parallel plane is the floor rather than the largest one, a table, when it has this share
/// of its area.
constexpr double kFloorShare = 0.25;

double angle(const Vector3d& a, const Vector3d& b) {
  return std::acos(std::clamp(a.dot(b), -1.0, 1.0));
}

/// Up before any floor is looked at; nothing when any direction will do.
std::optional<Vector3d> expected_up(const GroundHints& hints) {
  if (hints.up) return hints.up;
  if (hints.camera_pitch) {
    return Vector3d(0.0, -std::cos(*hints.camera_pitch), -std::sin(*hints.camera_pitch));
  }
  if (hints.optical_frame) return Vector3d(0.0, -1.0, 0.0);
  return std::nullopt;
}

double tolerance(const GroundHints& hints) {
  if (hints.up || hints.camera_pitch) return kAxisError;
  return hints.optical_frame ? kCameraTilt : std::numbers::pi;
}

/// A patch with its normal turned to the expected side.
PlanePatch facing(PlanePatch patch, const std::optional<Vector3d>& up) {
  if (up && patch.normal.dot(*up) < 0.0) {
    patch.normal = -patch.normal;
    patch.offset = -patch.offset;
  }
  return patch;
}

std::optional<PlanePatch> dominant_floor(const std::vector<PlanePatch>& planes,
                                         const GroundHints& hints) {
  const std::optional<Vector3d> up = expected_up(hints);
  std::optional<PlanePatch> largest;
  for (const PlanePatch& plane : planes) {
    const PlanePatch patch = facing(plane, up);
    if (up && angle(patch.normal, *up) > tolerance(hints)) continue;
    if (!largest || patch.points > largest->points) largest = patch;
  }
  if (!largest) return std::nullopt;
  std::optional<PlanePatch> floor = largest;
  for (const PlanePatch& plane : planes) {
    const PlanePatch patch = facing(plane, largest->normal);
    if (angle(patch.normal, largest->normal) > kParallel) continue;
    if (patch.points < kFloorShare * largest->points) continue;
    if (largest->normal.dot(patch.centroid) < largest->normal.dot(floor->centroid)) floor = patch;
  }
  return floor;
}

/// The floor with what belongs to it. All parallel patches, treads of stairs as well, tell which
/// way is up, each by its scatter about its own centre; those on the floor's level tell its height.
PlanePatch refined_floor(const std::vector<PlanePatch>& planes, const PlanePatch& floor) {
  constexpr double kSameLevel = 0.025;  // [m]
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
  for (const PlanePatch& plane : planes) {
    if (std::abs(plane.normal.dot(floor.normal)) >= std::cos(kParallel)) scatter += plane.scatter;
  }
  PlanePatch result = floor;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(scatter);
  result.normal = axes.eigenvectors().col(0);
  if (result.normal.dot(floor.normal) < 0.0) result.normal = -result.normal;
  const double level = result.normal.dot(floor.centroid);
  double weight = 0.0;
  double sum = 0.0;
  for (const PlanePatch& plane : planes) {
    const double height = result.normal.dot(plane.centroid);
    const bool parallel = std::abs(plane.normal.dot(result.normal)) >= std::cos(kParallel);
    if (!parallel || std::abs(height - level) > kSameLevel) continue;
    weight += plane.voxels;
    sum += plane.voxels * height;
  }
  result.offset = weight > 0.0 ? sum / weight : level;
  return result;
}

/// The part of an axis that is level, unit; nothing when the axis is upright.
std::optional<Vector3d> level_part(const Vector3d& axis, const Vector3d& up) {
  constexpr double kUpright = 0.2;  // sine of the angle between them
  const Vector3d level = axis - axis.dot(up) * up;
  if (level.norm() < kUpright) return std::nullopt;
  return level.normalized();
}

Vector3d forward_of(const GroundHints& hints, const Vector3d& up) {
  if (hints.forward) return level_part(*hints.forward, up).value_or(Vector3d::Zero());
  const std::optional<Vector3d> optical = level_part(Vector3d::UnitZ(), up);
  if (optical) return *optical;
  return level_part(Vector3d::UnitX(), up).value_or(Vector3d::UnitY());
}

}  // namespace

core::Result<GroundFrame> find_ground_frame(const std::vector<PlanePatch>& planes,
                                            const GroundHints& hints) {
  GroundFrame frame;
  frame.floor = dominant_floor(planes, hints);
  if (frame.floor) frame.floor = refined_floor(planes, *frame.floor);
  std::optional<Vector3d> up = expected_up(hints);
  // A pitch is a measurement, an axis only a name.
  if (frame.floor && !hints.camera_pitch) up = frame.floor->normal;
  const bool known = frame.floor || (hints.up && !hints.camera_height) ||
                     (hints.camera_height && (hints.camera_pitch || hints.up));
  if (!known || !up) {
    return core::Refusal{core::Reason::terrain_unseen,
                         "no floor plane was found; give the pose of the camera, or the up axis"};
  }
  const Vector3d forward = forward_of(hints, *up);
  if (forward.isZero(0.0)) {
    return core::Refusal{core::Reason::target_malformed, "the forward axis points up or down"};
  }
  Eigen::Matrix3d R_WR;
  R_WR.row(0) = forward;
  R_WR.row(1) = up->cross(forward);
  R_WR.row(2) = *up;
  frame.X_WR.linear() = R_WR;
  // Of the floor above the sensor; negative.
  const double below = frame.floor ? frame.floor->offset / frame.floor->normal.dot(*up) : 0.0;
  const bool own_heights = hints.up && !hints.camera_height;
  const double sensor_height = hints.camera_height.value_or(own_heights ? 0.0 : -below);
  frame.floor_height = frame.floor ? sensor_height + below : 0.0;
  frame.X_WR.translation() = Vector3d(-hints.origin.x(), -hints.origin.y(), sensor_height);
  return frame;
}

}  // namespace hopscotch::perception
