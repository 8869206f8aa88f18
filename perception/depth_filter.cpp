#include "perception/depth_filter.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "perception/depth_noise.hpp"

namespace hopscotch::perception {

struct DepthFilter::Images {
  cv::Mat lowest_input;  // depth with infinity where nothing was measured
  cv::Mat lowest;        // of each 3x3 neighbourhood
  cv::Mat highest;       // of each 3x3 neighbourhood
  cv::Mat body;          // 255 where the robot's own body may be
};

namespace {

/// Nearer parts of a capsule are cut off: they would fill the image.
constexpr double kNearPlane = 0.03;  // [m]
/// Outlines larger than this many image widths are cut; integer pixel arithmetic needs a bound.
constexpr double kPixelBound = 4.0;

/// Part of a capsule's line in front of the near plane; false when there is none.
bool clip(const Capsule& capsule, Eigen::Vector3d& start, Eigen::Vector3d& end) {
  start = capsule.start;
  end = capsule.end;
  if (start.z() < kNearPlane && end.z() < kNearPlane) return false;
  const double share = (kNearPlane - start.z()) / (end.z() - start.z());
  const Eigen::Vector3d cut = start + share * (end - start);
  if (start.z() < kNearPlane) start = cut;
  if (end.z() < kNearPlane) end = cut;
  return true;
}

struct Disc {
  cv::Point2d centre;
  double radius = 0.0;
};

Disc outline(const core::CameraIntrinsics& camera, const Eigen::Vector3d& p_C, double radius) {
  const double bound = kPixelBound * (camera.width + camera.height);
  const double u = camera.fx * p_C.x() / p_C.z() + camera.cx;
  const double v = camera.fy * p_C.y() / p_C.z() + camera.cy;
  return {{std::clamp(u, -bound, bound), std::clamp(v, -bound, bound)},
          std::min(std::max(camera.fx, camera.fy) * radius / p_C.z(), bound)};
}

void draw(const Disc& a, const Disc& b, cv::Mat& mask) {
  const cv::Scalar white(255);
  for (const Disc& disc : {a, b}) {
    cv::circle(mask, cv::Point(disc.centre), static_cast<int>(std::ceil(disc.radius)), white,
               cv::FILLED);
  }
  const cv::Point2d line = b.centre - a.centre;
  const double length = std::hypot(line.x, line.y);
  if (length < 1.0) return;
  const cv::Point2d across(-line.y / length, line.x / length);
  const std::array<cv::Point, 4> corners{
      cv::Point(a.centre + a.radius * across), cv::Point(b.centre + b.radius * across),
      cv::Point(b.centre - b.radius * across), cv::Point(a.centre - a.radius * across)};
  cv::fillConvexPoly(mask, corners.data(), static_cast<int>(corners.size()), white);
}

bool draw_body(const core::CameraIntrinsics& camera, const BodyCapsules& body,
               const DepthFilterConfig& config, cv::Mat& mask) {
  mask.create(camera.height, camera.width, CV_8U);
  mask.setTo(0);
  bool in_front = false;
  for (const Capsule& capsule : body) {
    Eigen::Vector3d start;
    Eigen::Vector3d end;
    if (!clip(capsule, start, end)) continue;
    const double radius = capsule.radius + config.mask_margin;
    Disc a = outline(camera, start, radius);
    Disc b = outline(camera, end, radius);
    a.radius += config.mask_margin_px;
    b.radius += config.mask_margin_px;
    draw(a, b, mask);
    in_front = true;
  }
  return in_front;
}

/// Copies the image for the two neighbourhood filters: what was not measured is 0 in `depth` and
/// the largest number in `lowest_input`. Returns how many pixels were measured.
int split_measured(const std::vector<float>& image, std::vector<float>& depth,
                   float* lowest_input) {
  constexpr float kLargest = std::numeric_limits<float>::max();
  int count = 0;
  for (std::size_t i = 0; i < image.size(); ++i) {
    const float z = image[i];
    const bool measured = (z > 0.0F) & (z <= kLargest);  // no branches: this loop runs in SIMD
    count += measured ? 1 : 0;
    depth[i] = measured ? z : 0.0F;
    lowest_input[i] = measured ? z : kLargest;
  }
  return count;
}

/// Removes pixels out of range and pixels whose neighbourhood jumps. Returns how many are left.
int keep_trusted(const DepthFilterConfig& config, const DepthNoiseConfig& noise,
                 const float* highest, const float* lowest, std::vector<float>& depth) {
  const float range_min = static_cast<float>(config.range_min);
  const float range_max = static_cast<float>(config.range_max);
  const float base = static_cast<float>(noise.base * config.jump_sigmas);
  const float quadratic = static_cast<float>(noise.quadratic * config.jump_sigmas);
  const float ratio = static_cast<float>(config.jump_ratio);
  int count = 0;
  for (std::size_t i = 0; i < depth.size(); ++i) {
    const float z = depth[i];
    const float by_ratio = ratio * z;
    const float by_noise = base + quadratic * z * z;
    const float jump = by_ratio > by_noise ? by_ratio : by_noise;
    const bool keep = (z >= range_min) & (z <= range_max) & (highest[i] - lowest[i] <= jump);
    count += keep ? 1 : 0;
    depth[i] = keep ? z : 0.0F;
  }
  return count;
}

}  // namespace

DepthFilter::DepthFilter(const DepthFilterConfig& config, const DepthNoiseConfig& noise)
    : config_(config), noise_(noise), images_(std::make_unique<Images>()) {}

DepthFilter::~DepthFilter() = default;

FilterCounts DepthFilter::filter(const core::DepthFrame& frame, const BodyCapsules& body,
                                 std::vector<float>& depth) {
  const int rows = frame.intrinsics.height;
  const int columns = frame.intrinsics.width;
  depth.resize(frame.depth.size());
  images_->lowest_input.create(rows, columns, CV_32F);
  FilterCounts counts;
  counts.measured = split_measured(frame.depth, depth, images_->lowest_input.ptr<float>());

  const cv::Mat highest_input(rows, columns, CV_32F, depth.data());
  const cv::Mat neighbourhood = cv::Mat::ones(3, 3, CV_8U);
  cv::dilate(highest_input, images_->highest, neighbourhood);
  cv::erode(images_->lowest_input, images_->lowest, neighbourhood);
  counts.kept = keep_trusted(config_, noise_, images_->highest.ptr<float>(),
                             images_->lowest.ptr<float>(), depth);
  if (draw_body(frame.intrinsics, body, config_, images_->body)) {
    cv::Mat kept(rows, columns, CV_32F, depth.data());
    kept.setTo(0.0F, images_->body);
    counts.kept = cv::countNonZero(kept);
  }
  return counts;
}

}  // namespace hopscotch::perception
