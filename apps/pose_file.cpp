#include "apps/pose_file.hpp"

#include <cmath>
#include <fstream>
#include <optional>
#include <sstream>
#include <string>

#include "core/config_reader.hpp"

namespace hopscotch::apps {

namespace {

namespace fs = std::filesystem;

constexpr double kImageRate = 30.0;  // where the file has no stamps [Hz]
/// Nobody carries a camera so far from one image to the next [m]: such poses are in another unit.
constexpr double kStrideMax = 5.0;
constexpr double kStampMax = 4e9;  // the year 2096 [s]

std::optional<fs::path> pose_file_in(const fs::path& folder) {
  std::optional<fs::path> found;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    const fs::path& path = entry.path();
    if (path.extension() != ".txt") continue;
    if (path.filename().string().find("pose") == std::string::npos) continue;
    if (found) throw core::ConfigError(folder.string() + ": holds more than one pose file");
    found = path;
  }
  return found;
}

CameraPose pose_of_line(const std::string& place, const std::vector<double>& numbers,
                        std::size_t index) {
  if (numbers.size() != 7 && numbers.size() != 8) {
    throw core::ConfigError(place + ": " + std::to_string(numbers.size()) +
                            " numbers, but a pose is [stamp] tx ty tz qx qy qz qw");
  }
  const bool stamped = numbers.size() == 8;
  const double* p = numbers.data() + (stamped ? 1 : 0);
  const Eigen::Quaterniond q(p[6], p[3], p[4], p[5]);
  constexpr double kUnit = 0.01;
  if (!(std::abs(q.norm() - 1.0) <= kUnit)) {
    throw core::ConfigError(place + ": the quaternion is not of length 1");
  }
  if (stamped && !(std::abs(numbers[0]) <= kStampMax)) {
    throw core::ConfigError(place + ": the stamp is in seconds; this one is beyond the year 2096");
  }
  CameraPose pose;
  pose.stamp =
      core::Stamp::from_seconds(stamped ? numbers[0] : static_cast<double>(index + 1) / kImageRate);
  pose.X_VC.linear() = q.normalized().toRotationMatrix();
  pose.X_VC.translation() << p[0], p[1], p[2];
  if (!pose.X_VC.matrix().allFinite()) throw core::ConfigError(place + ": not a number");
  return pose;
}

std::vector<CameraPose> read_poses(const fs::path& file) {
  std::ifstream stream(file);
  std::vector<CameraPose> poses;
  int line_number = 0;
  for (std::string line; std::getline(stream, line);) {
    ++line_number;
    std::istringstream words(line);
    std::vector<double> numbers;
    for (double number = 0.0; words >> number;) numbers.push_back(number);
    if (numbers.empty()) continue;  // a comment or an empty line
    poses.push_back(
        pose_of_line(file.string() + ":" + std::to_string(line_number), numbers, poses.size()));
  }
  return poses;
}

/// The number at the end of a name, "depth_12.png" -> 12.
std::optional<std::size_t> number_in(const fs::path& image) {
  const std::string stem = image.stem().string();
  std::size_t first = stem.size();
  while (first > 0 && stem[first - 1] >= '0' && stem[first - 1] <= '9') --first;
  const std::string digits = stem.substr(first);
  if (digits.empty() || digits.size() > 6) return std::nullopt;
  return static_cast<std::size_t>(std::stoul(digits));
}

}  // namespace

std::vector<CameraPose> poses_of_images(const fs::path& folder,
                                        const std::vector<fs::path>& images) {
  std::vector<CameraPose> result(images.size());
  for (std::size_t i = 0; i < images.size(); ++i) {
    result[i].stamp = core::Stamp::from_seconds(static_cast<double>(i + 1) / kImageRate);
  }
  const std::optional<fs::path> file = pose_file_in(folder);
  if (!file) return result;
  const std::vector<CameraPose> poses = read_poses(*file);
  for (std::size_t i = 0; i < images.size(); ++i) {
    // With as many lines as images they go together one by one; else names count from 1.
    std::size_t line = i;
    if (poses.size() != images.size()) line = number_in(images[i]).value_or(0) - 1;
    if (line >= poses.size()) {
      throw core::ConfigError(file->string() + ": has no pose for " +
                              images[i].filename().string());
    }
    result[i] = poses[line];
  }
  for (std::size_t i = 1; i < result.size(); ++i) {
    if (result[i].stamp <= result[i - 1].stamp) {
      throw core::ConfigError(file->string() + ": time goes backwards at " +
                              images[i].filename().string());
    }
    const double stride = (result[i].X_VC.translation() - result[i - 1].X_VC.translation()).norm();
    if (stride > kStrideMax) {
      throw core::ConfigError(file->string() + ": the camera would have moved " +
                              std::to_string(std::lround(stride)) + " m before " +
                              images[i].filename().string() + "; poses are read in metres");
    }
  }
  return result;
}

}  // namespace hopscotch::apps
