#include "apps/key_frames.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <stdexcept>
#include <vector>

#include "apps/caption.hpp"
#include "apps/following_camera.hpp"
#include "apps/report_data.hpp"
#include "apps/text_file.hpp"
#include "sim/scene_renderer.hpp"

namespace hopscotch::apps {

namespace {

void save(const std::filesystem::path& file, const cv::Mat& rgb) {
  cv::Mat bgr;
  cv::cvtColor(rgb, bgr, cv::COLOR_RGB2BGR);
  if (!cv::imwrite(file.string(), bgr)) throw std::runtime_error("cannot write " + file.string());
}

/// "03-2-lift-off.png": sorts by jump, then by time.
std::string picture_name(const JumpRecord& jump, std::size_t instant) {
  const std::string number = std::to_string(jump.index);
  std::string name = number.size() < 2 ? "0" : "";
  name.append(number).append("-").append(std::to_string(instant + 1)).append("-");
  return name.append(kInstantNames[instant]).append(".png");
}

/// The following camera's view, nearer: the robot fills the picture.
sim::View close_view(const core::RobotState& state) {
  constexpr double kNearer = 0.78;
  sim::View view = FollowingCamera().view(state, 0.0);
  view.distance *= kNearer;
  return view;
}

void draw_instants(const RunFolder& folder, const RunRecord& run, const std::string& mjcf) {
  constexpr int kWidth = 640;
  constexpr int kHeight = 360;
  sim::SceneRenderer renderer(mjcf, kWidth, kHeight, sim::Quality::still);
  sim::RgbImage image;
  for (const JumpRecord& jump : run.jumps) {
    for (std::size_t i = 0; i < jump.instants.size(); ++i) {
      const double time = jump.instants[i];
      if (!std::isfinite(time)) continue;
      const core::RobotState& state = run.moment_at(time).state;
      renderer.render(state, close_view(state), image);
      save(folder.frames() / picture_name(jump, i), as_matrix(image));
    }
  }
}

/// Moments that tell the crossing without covering one another: start, every apex, end.
std::vector<double> crossing_times(const RunRecord& run) {
  std::vector<double> times{run.moments.front().time};
  for (const JumpRecord& jump : run.jumps) {
    if (std::isfinite(jump.at(Instant::apex))) times.push_back(jump.at(Instant::apex));
  }
  times.push_back(run.moments.back().time);
  return times;
}

/// A picture of the whole course from the side, from so far away that it is almost to scale.
struct Panorama {
  sim::View view;
  int width = 1920;
  int height = 0;
};

Panorama panorama_of(const RunRecord& run) {
  const std::vector<double> times = crossing_times(run);
  constexpr double kSide = 0.45;         // around the trunks [m]
  constexpr double kAbove = 0.38;        // of the highest trunk [m]
  constexpr double kBelow = 0.75;        // of the lowest trunk [m]
  constexpr double kFieldOfView = 0.12;  // [rad]
  Eigen::Vector3d low = run.moment_at(times.front()).state.p_WB;
  Eigen::Vector3d high = low;
  for (const double time : times) {
    const Eigen::Vector3d& p_WB = run.moment_at(time).state.p_WB;
    low = low.cwiseMin(p_WB);
    high = high.cwiseMax(p_WB);
  }
  low -= Eigen::Vector3d(kSide, 0.0, kBelow);
  high += Eigen::Vector3d(kSide, 0.0, kAbove);
  Panorama result;
  const double length = high.x() - low.x();
  result.height =
      std::clamp(static_cast<int>(result.width * (high.z() - low.z()) / length), 240, 1080);
  const double shown_height = length * result.height / result.width;
  result.view = {.target = 0.5 * (low + high),
                 .distance = 0.5 * shown_height / std::tan(0.5 * kFieldOfView),
                 .azimuth = kSideways,
                 .elevation = -0.10,
                 .field_of_view = kFieldOfView};
  return result;
}

/// Pixels in which two pictures differ.
cv::Mat changed_pixels(const cv::Mat& a, const cv::Mat& b) {
  constexpr double kDifference = 14.0;  // of 255: above the noise of smoothed edges
  cv::Mat difference;
  cv::Mat mask;
  cv::absdiff(a, b, difference);
  cv::inRange(difference, cv::Scalar::all(0.0), cv::Scalar::all(kDifference), mask);
  cv::bitwise_not(mask, mask);
  return mask;
}

/// Many exposures on one plate: what differs from the empty scene is copied over it, first the
/// shadows, then the robots, so that no shadow falls on another robot.
cv::Mat expose(sim::SceneRenderer& renderer, const RunRecord& run, const sim::View& view) {
  constexpr double kAway = 1000.0;  // out of sight [m]
  sim::RgbImage image;
  core::RobotState away = run.moments.front().state;
  away.p_WB.x() += kAway;
  renderer.render(away, view, image);
  const cv::Mat empty = as_matrix(image).clone();
  cv::Mat plate = empty.clone();
  for (const double time : crossing_times(run)) {
    renderer.render(run.moment_at(time).state, view, image);
    const cv::Mat exposure = as_matrix(image);
    exposure.copyTo(plate, changed_pixels(exposure, empty));
  }
  sim::View shadowless = view;
  shadowless.shadows = sim::Shadows::omitted;
  renderer.render(away, shadowless, image);
  const cv::Mat bright = as_matrix(image).clone();
  for (const double time : crossing_times(run)) {
    renderer.render(run.moment_at(time).state, shadowless, image);
    const cv::Mat exposure = as_matrix(image);
    exposure.copyTo(plate, changed_pixels(exposure, bright));
  }
  return plate;
}

void draw_crossing_picture(const RunFolder& folder, const RunRecord& run, const std::string& mjcf) {
  const Panorama panorama = panorama_of(run);
  sim::SceneRenderer renderer(mjcf, panorama.width, panorama.height, sim::Quality::still);
  save(folder.frames() / kCrossingPicture, expose(renderer, run, panorama.view));
}

}  // namespace

std::optional<std::string> draw_key_frames(const RunFolder& folder) {
  const RunRecord run = load_run(folder);
  if (run.moments.empty()) return std::nullopt;
  const std::string mjcf = read_file(folder.scene());
  std::filesystem::create_directories(folder.frames());
  try {
    draw_instants(folder, run, mjcf);
    draw_crossing_picture(folder, run, mjcf);
  } catch (const sim::RendererUnavailable& lack) {
    return lack.what();
  }
  return std::nullopt;
}

}  // namespace hopscotch::apps
