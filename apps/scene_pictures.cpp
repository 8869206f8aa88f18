#include "apps/scene_pictures.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

namespace hopscotch::apps {

namespace {

using Eigen::Vector3d;

const cv::Scalar kUpColour(60, 220, 60);  // blue, green, red
const cv::Scalar kDownColour(0, 150, 255);
const cv::Scalar kGapColour(60, 60, 255);
const cv::Scalar kTargetColour(255, 230, 120);
const cv::Scalar kChosenColour(255, 255, 255);
const cv::Scalar kRejectedColour(140, 90, 255);
constexpr double kEdgeHalfWidth = 0.15;  // edges are drawn across both tracks [m]
constexpr double kHalfStance = 0.098;
constexpr double kSoleHalfLength = 0.075;
constexpr double kSoleHalfWidth = 0.010;

/// Where a point of S is in a picture; nothing outside or behind the camera.
using Projection = std::function<std::optional<cv::Point>(const Vector3d& p_S)>;

Eigen::Isometry3d pose_of_S(const core::OneStepTerrain& terrain) {
  Eigen::Isometry3d X_WS = Eigen::Isometry3d::Identity();
  X_WS.linear() = Eigen::AngleAxisd(terrain.heading, Vector3d::UnitZ()).toRotationMatrix();
  X_WS.translation() = terrain.p_WS;
  return X_WS;
}

void line(cv::Mat& picture, const Projection& project, const Vector3d& from, const Vector3d& to,
          const cv::Scalar& colour) {
  const std::optional<cv::Point> a = project(from);
  const std::optional<cv::Point> b = project(to);
  if (a && b) cv::line(picture, *a, *b, colour, 2, cv::LINE_AA);
}

/// Right of a place, with a dark rim: it is read on any ground.
void label(cv::Mat& picture, const cv::Point& place, const std::string& text,
           const cv::Scalar& colour) {
  constexpr double kSize = 0.4;
  const cv::Point start = place + cv::Point(6, 4);
  cv::putText(picture, text, start, cv::FONT_HERSHEY_SIMPLEX, kSize, cv::Scalar::all(0), 3,
              cv::LINE_AA);
  cv::putText(picture, text, start, cv::FONT_HERSHEY_SIMPLEX, kSize, colour, 1, cv::LINE_AA);
}

std::string metres(double value) {
  char text[24];
  std::snprintf(text, sizeof text, "%.2f m", value);
  return text;
}

/// What an edge is and how high its step.
std::string name_of(const core::TerrainEdge& edge) {
  const std::string step = std::isfinite(edge.step) ? " " + metres(edge.step) : "";
  switch (edge.kind) {
    case core::EdgeKind::up: return "up" + step;
    case core::EdgeKind::down: return "down" + step;
    case core::EdgeKind::gap_near: return "ends";
    case core::EdgeKind::gap_far: return "begins" + step;
  }
  return "";
}

/// Height of the profile at x, zero where nothing is known.
double height_at(const core::TerrainProfile& profile, double x) {
  const double mean = profile.mean[static_cast<std::size_t>(core::TerrainProfile::sample(x))];
  return std::isfinite(mean) ? mean : 0.0;
}

/// By how much the ground is higher behind an edge than before it; a gap counts at its far side.
double rise_at(const core::TerrainEdge& edge) {
  return std::isfinite(edge.step) && edge.kind != core::EdgeKind::gap_near ? edge.step : 0.0;
}

void draw_edges(cv::Mat& picture, const Projection& project, const TerrainReport& report) {
  const core::OneStepTerrain& features = report.survey.features;
  double level = 0.0;  // under the soles; steps that lie behind them lead up to it
  for (std::size_t i = 0; i < features.edge_count; ++i) {
    if (features.edges[i].x < 0.0) level -= rise_at(features.edges[i]);
  }
  for (std::size_t i = 0; i < features.edge_count; ++i) {
    const core::TerrainEdge& edge = features.edges[i];
    const double step = rise_at(edge);
    const bool up = edge.kind == core::EdgeKind::up;
    const bool far = edge.kind == core::EdgeKind::gap_far;
    const double height = up || far ? level + step : level;
    const cv::Scalar& colour =
        up ? kUpColour : (edge.kind == core::EdgeKind::down ? kDownColour : kGapColour);
    line(picture, project, {edge.x, kEdgeHalfWidth, height}, {edge.x, -kEdgeHalfWidth, height},
         colour);
    const auto right = project({edge.x, -kEdgeHalfWidth, height});
    if (right) label(picture, *right, name_of(edge), colour);
    level += step;
  }
}

void draw_soles(cv::Mat& picture, const Projection& project, const core::RankedTarget& target,
                const cv::Scalar& colour) {
  for (const double side : {kHalfStance, -kHalfStance}) {
    std::vector<cv::Point> corners;
    for (const auto& [dx, dy] : {std::pair{1, 1}, {1, -1}, {-1, -1}, {-1, 1}}) {
      const auto corner = project(
          {target.distance + dx * kSoleHalfLength, side + dy * kSoleHalfWidth, target.height});
      if (corner) corners.push_back(*corner);
    }
    if (corners.size() == 4) cv::polylines(picture, corners, true, colour, 1, cv::LINE_AA);
  }
}

void draw_choice(cv::Mat& picture, const Projection& project, const TerrainReport& report) {
  const core::TargetChoice& choice = report.choice;
  core::Reason told = core::Reason::none;  // a reason is written at the first of its places
  for (std::size_t i = 0; i < choice.rejected_count; ++i) {
    const core::RejectedTarget& rejected = choice.rejected[i];
    const double x = rejected.distance;
    const auto place = project({x, 0.0, height_at(report.terrain.profile, x)});
    if (!place) continue;
    cv::drawMarker(picture, *place, kRejectedColour, cv::MARKER_TILTED_CROSS, 7, 1, cv::LINE_AA);
    if (rejected.why != told) {
      label(picture, *place, std::string(core::reason_code(rejected.why)), kRejectedColour);
    }
    told = rejected.why;
  }
  for (std::size_t i = choice.ranked_count; i > 0; --i) {
    draw_soles(picture, project, choice.ranked[i - 1], kTargetColour);
  }
  if (choice.target) {
    draw_soles(picture, project,
               {.distance = choice.target->distance, .height = choice.target->height},
               kChosenColour);
    const auto beside = project({choice.target->distance, -kEdgeHalfWidth, choice.target->height});
    char text[48];
    std::snprintf(text, sizeof text, "%.2f m, safe %.4f", choice.target->distance,
                  choice.target->safe_probability);
    if (beside) label(picture, *beside, text, kChosenColour);
  }
}

/// Two ends of the colour scale: nearly all observed heights lie between them.
std::pair<float, float> height_range(const core::TerrainMap& map) {
  std::vector<float> heights;
  for (const core::TerrainCell& cell : map.cells) {
    if (cell.state == core::CellState::observed) heights.push_back(cell.height);
  }
  if (heights.empty()) return {0.0F, 1.0F};
  std::sort(heights.begin(), heights.end());
  const float low = heights[heights.size() / 50];
  const float high = heights[heights.size() - 1 - heights.size() / 50];
  constexpr float kLeast = 0.05F;  // level ground is one colour, not a picture of its noise
  return {low, std::max(high, low + kLeast)};
}

/// A line every half metre ahead of the soles, and what the colours mean.
void draw_scales(cv::Mat& picture, const Projection& project, double low, double high) {
  constexpr double kTick = 0.5;  // [m]
  constexpr int kTicks = 8;
  constexpr int kTickLength = 12;  // [pixel]
  const cv::Scalar white = cv::Scalar::all(255);
  for (int i = 0; i <= kTicks; ++i) {
    const auto place = project({i * kTick, 0.0, 0.0});
    if (!place || place->y < 0 || place->y >= picture.rows) continue;
    cv::line(picture, {0, place->y}, {kTickLength, place->y}, white, 1);
    label(picture, {kTickLength, place->y}, metres(i * kTick), white);
  }
  constexpr int kKeyHeight = 120;
  constexpr int kKeyWidth = 14;
  const cv::Rect where(picture.cols - 90, 16, kKeyWidth, kKeyHeight);
  if (where.x < 0 || where.y + where.height > picture.rows) return;
  cv::Mat grey(kKeyHeight, kKeyWidth, CV_8U);
  for (int row = 0; row < kKeyHeight; ++row) grey.row(row) = 255 - 255 * row / (kKeyHeight - 1);
  cv::Mat colours;
  cv::applyColorMap(grey, colours, cv::COLORMAP_VIRIDIS);
  colours.copyTo(picture(where));
  cv::rectangle(picture, where, white, 1);
  label(picture, {where.x + kKeyWidth, where.y + 4}, metres(high), white);
  label(picture, {where.x + kKeyWidth, where.y + kKeyHeight - 4}, metres(low), white);
}

void save(const std::filesystem::path& file, const cv::Mat& picture) {
  if (!cv::imwrite(file.string(), picture)) {
    throw std::runtime_error("cannot write " + file.string());
  }
}

}  // namespace

void draw_map(const std::filesystem::path& file, const core::TerrainMap& map,
              const TerrainReport& report) {
  constexpr int kScale = 5;                                    // pixels a cell
  cv::Mat grey(map.size_x, map.size_y, CV_8U, cv::Scalar(0));  // ahead is up, left is left
  cv::Mat colour;
  const auto [low, high] = height_range(map);
  const auto row_of = [&](int ix) { return map.size_x - 1 - ix; };
  const auto column_of = [&](int iy) { return map.size_y - 1 - iy; };
  for (int iy = 0; iy < map.size_y; ++iy) {
    for (int ix = 0; ix < map.size_x; ++ix) {
      const float share = (map.at(ix, iy).height - low) / (high - low);
      grey.at<std::uint8_t>(row_of(ix), column_of(iy)) =
          static_cast<std::uint8_t>(255.0F * std::clamp(share, 0.0F, 1.0F));
    }
  }
  cv::applyColorMap(grey, colour, cv::COLORMAP_VIRIDIS);
  for (int iy = 0; iy < map.size_y; ++iy) {
    for (int ix = 0; ix < map.size_x; ++ix) {
      const core::CellState state = map.at(ix, iy).state;
      if (state == core::CellState::observed) continue;
      const std::uint8_t shade = state == core::CellState::occluded ? 60 : 0;
      colour.at<cv::Vec3b>(row_of(ix), column_of(iy)) = cv::Vec3b::all(shade);
    }
  }
  cv::Mat picture;
  cv::resize(colour, picture, {}, kScale, kScale, cv::INTER_NEAREST);
  const Eigen::Isometry3d X_WS = pose_of_S(report.terrain);
  const Projection project = [&](const Vector3d& p_S) -> std::optional<cv::Point> {
    const Vector3d p = X_WS * p_S;
    const double along = (p.x() - map.origin_x) / map.resolution;
    const double across = (p.y() - map.origin_y) / map.resolution;
    return cv::Point(static_cast<int>(kScale * (map.size_y - across)),
                     static_cast<int>(kScale * (map.size_x - along)));
  };
  draw_scales(picture, project, low - report.terrain.p_WS.z(), high - report.terrain.p_WS.z());
  draw_edges(picture, project, report);
  draw_choice(picture, project, report);
  save(file, picture);
}

void draw_over_depth(const std::filesystem::path& file, const core::DepthFrame& frame,
                     const Eigen::Isometry3d& X_WC, const TerrainReport& report) {
  constexpr double kFarthest = 3.0;  // colours end there [m]
  const core::CameraIntrinsics& lens = frame.intrinsics;
  cv::Mat grey(lens.height, lens.width, CV_8U);
  for (int v = 0; v < lens.height; ++v) {
    for (int u = 0; u < lens.width; ++u) {
      const float z = frame.depth[static_cast<std::size_t>(v * lens.width + u)];
      const double share = 1.0 - std::min(1.0, static_cast<double>(z) / kFarthest);
      grey.at<std::uint8_t>(v, u) = z > 0.0F ? static_cast<std::uint8_t>(30 + 200 * share) : 0;
    }
  }
  cv::Mat picture;
  cv::cvtColor(grey, picture, cv::COLOR_GRAY2BGR);
  const Eigen::Isometry3d X_CS = X_WC.inverse() * pose_of_S(report.terrain);
  const Projection project = [&](const Vector3d& p_S) -> std::optional<cv::Point> {
    constexpr double kNearest = 0.05;    // [m]
    constexpr double kFarOutside = 1e4;  // [pixel]
    const Vector3d p = X_CS * p_S;
    if (p.z() < kNearest) return std::nullopt;
    const double u = lens.fx * p.x() / p.z() + lens.cx;
    const double v = lens.fy * p.y() / p.z() + lens.cy;
    if (std::abs(u) > kFarOutside || std::abs(v) > kFarOutside) return std::nullopt;
    return cv::Point(static_cast<int>(u), static_cast<int>(v));
  };
  draw_edges(picture, project, report);
  draw_choice(picture, project, report);
  save(file, picture);
}

}  // namespace hopscotch::apps
