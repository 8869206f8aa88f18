#include "sim/depth_renderer.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "core/check.hpp"

namespace hopscotch::sim {
namespace {

/// Surfaces closer to the optical centre than this are cut away, which keeps 1/z bounded [m].
constexpr double kClipDepth = 0.01;

/// A face cut by the plane z = kClipDepth has at most one corner more than before.
struct Polygon {
  std::array<Eigen::Vector3d, 5> corners;  // in C [m]
  std::size_t count = 0;
};

Polygon clip_to_front(const Face& face, const Eigen::Isometry3d& X_CW) {
  Polygon polygon;
  Eigen::Vector3d previous = X_CW * face.corners.back();
  for (const Eigen::Vector3d& corner_W : face.corners) {
    const Eigen::Vector3d corner = X_CW * corner_W;
    const bool inside = corner.z() >= kClipDepth;
    if (inside != (previous.z() >= kClipDepth)) {
      const double share = (kClipDepth - previous.z()) / (corner.z() - previous.z());
      polygon.corners[polygon.count++] = previous + share * (corner - previous);
    }
    if (inside) polygon.corners[polygon.count++] = corner;
    previous = corner;
  }
  return polygon;
}

/// 1/z over the screen: at_origin + per_column u + per_row v [1/m].
struct InverseDepth {
  double at_origin;
  double per_column;
  double per_row;
};

/// The points of a plane n·p = d seen along the ray (x', y', 1) z have 1/z = n·(x', y', 1) / d.
/// Nothing when the plane passes through the optical centre: it is then seen as a line.
std::optional<InverseDepth> inverse_depth(const Face& face, const Eigen::Isometry3d& X_CW,
                                          const core::CameraIntrinsics& camera) {
  constexpr double kEdgeOn = 1e-6;  // [m], below the precision of single floats at arm's length
  const std::array<Eigen::Vector3d, 4>& c = face.corners;
  const Eigen::Vector3d n = X_CW.linear() * (c[2] - c[0]).cross(c[3] - c[1]).normalized();
  const double d = n.dot(X_CW * (0.25 * (c[0] + c[1] + c[2] + c[3])));
  if (!(std::abs(d) > kEdgeOn)) return std::nullopt;
  const double per_column = n.x() / (d * camera.fx);
  const double per_row = n.y() / (d * camera.fy);
  return InverseDepth{n.z() / d - per_column * camera.cx - per_row * camera.cy, per_column,
                      per_row};
}

/// First and last pixel position within [lowest, highest] of an image line of `size` pixels.
struct PixelRange {
  int first;
  int last;
};
PixelRange pixels_between(double lowest, double highest, int size) {
  const double limit = size;
  return {static_cast<int>(std::ceil(std::clamp(lowest, 0.0, limit))),
          static_cast<int>(std::floor(std::clamp(highest, -1.0, limit - 1.0)))};
}

/// Columns that a convex polygon covers in each image row it touches; returns those rows.
PixelRange find_spans(const Polygon& polygon, const core::CameraIntrinsics& camera,
                      std::vector<ColumnSpan>& spans) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  std::array<Eigen::Vector2d, 5> screen;
  double top = kInfinity;
  double bottom = -kInfinity;
  for (std::size_t i = 0; i < polygon.count; ++i) {
    const Eigen::Vector3d& p = polygon.corners[i];
    screen[i] = {camera.fx * p.x() / p.z() + camera.cx, camera.fy * p.y() / p.z() + camera.cy};
    top = std::min(top, screen[i].y());
    bottom = std::max(bottom, screen[i].y());
  }
  const PixelRange rows = pixels_between(top, bottom, camera.height);
  for (int v = rows.first; v <= rows.last; ++v) {
    spans[static_cast<std::size_t>(v)] = {kInfinity, -kInfinity};
  }
  for (std::size_t i = 0; i < polygon.count; ++i) {
    const Eigen::Vector2d& from = screen[i];
    const Eigen::Vector2d edge = screen[(i + 1) % polygon.count] - from;
    const PixelRange crossed =
        pixels_between(std::min(from.y(), from.y() + edge.y()),
                       std::max(from.y(), from.y() + edge.y()), camera.height);
    if (edge.y() == 0.0) continue;  // its ends belong to the neighbouring edges too
    for (int v = crossed.first; v <= crossed.last; ++v) {
      const double u = from.x() + (v - from.y()) / edge.y() * edge.x();
      ColumnSpan& span = spans[static_cast<std::size_t>(v)];
      span = {std::min(span.left, u), std::max(span.right, u)};
    }
  }
  return rows;
}

void keep_nearer(float* row, int count, float start, float step) {
  for (int i = 0; i < count; ++i) {
    row[i] = std::max(row[i], start + step * static_cast<float>(i));
  }
}

/// Pixel positions along one axis that a capsule may cover: the hull of the directions to its two
/// end spheres in the plane of that axis and the optical axis, cut to the half plane ahead.
PixelRange capsule_bounds(const Eigen::Vector2d& a, const Eigen::Vector2d& b, double radius,
                          const std::array<double, 2>& focal_and_centre, int size) {
  constexpr double kTurn = 2.0 * std::numbers::pi;
  constexpr double kAhead = 0.5 * std::numbers::pi;
  constexpr double kTiny = 1e-12;  // [m^2] an axis that is seen end-on in this plane
  const Eigen::Vector2d along = b - a;
  const double closest = std::clamp(-a.dot(along) / std::max(along.squaredNorm(), kTiny), 0.0, 1.0);
  if ((a + closest * along).norm() <= radius) return {0, size - 1};  // all around the origin
  const double angle_a = std::atan2(a.x(), a.y());
  const double angle_b = angle_a + std::remainder(std::atan2(b.x(), b.y()) - angle_a, kTurn);
  const double half_a = std::asin(radius / a.norm());
  const double half_b = std::asin(radius / b.norm());
  const double lowest = std::min(angle_a - half_a, angle_b - half_b);
  const double highest = std::max(angle_a + half_a, angle_b + half_b);
  double first = std::numeric_limits<double>::infinity();
  double last = -first;
  for (const double shift : {-kTurn, 0.0, kTurn}) {
    const double from = std::max(lowest + shift, -kAhead);
    const double to = std::min(highest + shift, kAhead);
    if (from >= to) continue;
    first = std::min(first, focal_and_centre[0] * std::tan(from) + focal_and_centre[1]);
    last = std::max(last, focal_and_centre[0] * std::tan(to) + focal_and_centre[1]);
  }
  return pixels_between(first, last, size);
}

/// Ray (x', y', 1) z against a capsule: the quadratic A z^2 + 2 B z + C = 0 of the infinite
/// cylinder, times |b - a|^2; where it meets the cylinder beyond an end, that end's sphere.
struct CapsuleQuadratic {
  Eigen::Vector3f axis;       // b - a
  Eigen::Vector3f a, b;       // ends, in C [m]
  Eigen::Vector3f B_per_ray;  // B is linear in the ray
  float axis_squared;
  float axis_dot_start;  // -a·(b - a)
  float C;
  float sphere_C_a, sphere_C_b;

  CapsuleQuadratic(const Eigen::Vector3d& a_C, const Eigen::Vector3d& b_C, double radius)
      : axis((b_C - a_C).cast<float>()), a(a_C.cast<float>()), b(b_C.cast<float>()) {
    const Eigen::Vector3d along = b_C - a_C;
    const double length_squared = along.squaredNorm();
    const double start = -a_C.dot(along);
    axis_squared = static_cast<float>(length_squared);
    axis_dot_start = static_cast<float>(start);
    B_per_ray = (-length_squared * a_C - start * along).cast<float>();
    C = static_cast<float>(along.cross(a_C).squaredNorm() - radius * radius * length_squared);
    sphere_C_a = static_cast<float>(a_C.squaredNorm() - radius * radius);
    sphere_C_b = static_cast<float>(b_C.squaredNorm() - radius * radius);
  }

  /// 1/z where the ray enters the capsule, 0 if it misses. Free of branches, for the vectoriser.
  [[nodiscard]] float inverse_depth(float x, float y) const {
    constexpr float kAlongAxis = 1e-7F;  // squared sine that single precision takes for zero
    const float ray_squared = x * x + y * y + 1.0F;
    const float axis_dot_ray = axis.x() * x + axis.y() * y + axis.z();
    const float across = axis_squared * ray_squared - axis_dot_ray * axis_dot_ray;
    const float A = std::max(across, kAlongAxis * axis_squared);
    const float B = B_per_ray.x() * x + B_per_ray.y() * y + B_per_ray.z();
    const float h = B * B - A * C;
    const float z_side = (-B - std::sqrt(std::max(h, 0.0F))) / A;
    // Along the axis from a, times its length.
    const float position = axis_dot_start + z_side * axis_dot_ray;
    const bool before = position <= 0.0F;
    const float toward = before ? a.x() * x + a.y() * y + a.z() : b.x() * x + b.y() * y + b.z();
    const float sphere_C = before ? sphere_C_a : sphere_C_b;
    const float sphere_h = toward * toward - ray_squared * sphere_C;
    const float z_end = (toward - std::sqrt(std::max(sphere_h, 0.0F))) / ray_squared;
    const bool on_side = (position > 0.0F) & (position < axis_squared);
    const float z = on_side ? z_side : z_end;
    const float limiting_h = on_side ? h : std::min(h, sphere_h);
    const bool hit = (limiting_h >= 0.0F) & (z > static_cast<float>(kClipDepth));
    return hit ? 1.0F / z : 0.0F;
  }
};

}  // namespace

DepthRenderer::DepthRenderer(const core::CameraIntrinsics& intrinsics, const DepthRange& range)
    : intrinsics_(intrinsics), range_(range) {
  HOPSCOTCH_CHECK(intrinsics.width > 0 && intrinsics.height > 0);
  const std::size_t columns = static_cast<std::size_t>(intrinsics.width);
  const std::size_t rows = static_cast<std::size_t>(intrinsics.height);
  inverse_depth_.resize(columns * rows);
  spans_.resize(rows);
  ray_x_.resize(columns);
  for (std::size_t u = 0; u < columns; ++u) {
    ray_x_[u] = static_cast<float>((static_cast<double>(u) - intrinsics.cx) / intrinsics.fx);
  }
}

void DepthRenderer::render(std::span<const Face> faces, std::span<const Capsule> capsules,
                           const Eigen::Isometry3d& X_WC, std::vector<float>& depth) {
  const Eigen::Isometry3d X_CW = X_WC.inverse();
  std::fill(inverse_depth_.begin(), inverse_depth_.end(), 0.0F);
  for (const Face& face : faces) draw_face(face, X_CW);
  for (const Capsule& capsule : capsules) draw_capsule(capsule, X_CW);

  depth.resize(inverse_depth_.size());
  const float nearest = static_cast<float>(range_.nearest);
  const float farthest = static_cast<float>(range_.farthest);
  for (std::size_t i = 0; i < depth.size(); ++i) {
    const float z = 1.0F / inverse_depth_[i];
    depth[i] = (z >= nearest) & (z <= farthest) ? z : 0.0F;
  }
}

void DepthRenderer::draw_face(const Face& face, const Eigen::Isometry3d& X_CW) {
  const Polygon polygon = clip_to_front(face, X_CW);
  if (polygon.count < 3) return;
  const std::optional<InverseDepth> plane = inverse_depth(face, X_CW, intrinsics_);
  if (!plane) return;
  const PixelRange rows = find_spans(polygon, intrinsics_, spans_);
  for (int v = rows.first; v <= rows.last; ++v) {
    const ColumnSpan& span = spans_[static_cast<std::size_t>(v)];
    const PixelRange columns = pixels_between(span.left, span.right, intrinsics_.width);
    const double start = plane->at_origin + plane->per_column * columns.first + plane->per_row * v;
    keep_nearer(row(v) + columns.first, columns.last - columns.first + 1, static_cast<float>(start),
                static_cast<float>(plane->per_column));
  }
}

void DepthRenderer::draw_capsule(const Capsule& capsule, const Eigen::Isometry3d& X_CW) {
  const Eigen::Vector3d a = X_CW * capsule.a;
  const Eigen::Vector3d b = X_CW * capsule.b;
  const PixelRange columns = capsule_bounds({a.x(), a.z()}, {b.x(), b.z()}, capsule.radius,
                                            {intrinsics_.fx, intrinsics_.cx}, intrinsics_.width);
  const PixelRange rows = capsule_bounds({a.y(), a.z()}, {b.y(), b.z()}, capsule.radius,
                                         {intrinsics_.fy, intrinsics_.cy}, intrinsics_.height);
  const CapsuleQuadratic quadratic(a, b, capsule.radius);
  for (int v = rows.first; v <= rows.last; ++v) {
    const float y = static_cast<float>((v - intrinsics_.cy) / intrinsics_.fy);
    float* const pixels = row(v);
    const float* const x = ray_x_.data();
    for (int u = columns.first; u <= columns.last; ++u) {
      pixels[u] = std::max(pixels[u], quadratic.inverse_depth(x[u], y));
    }
  }
}

}  // namespace hopscotch::sim
