#include "apps/depth_image_file.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <opencv2/core.hpp>
#include <opencv2/core/utils/logger.hpp>
#include <opencv2/imgcodecs.hpp>
#include <string>

#include "core/config_reader.hpp"
#include "core/input_file.hpp"

namespace hopscotch::apps {

namespace {

namespace fs = std::filesystem;

constexpr std::uintmax_t kLargest = 256;  // [MiB]
/// Depth cameras for robots measure between these; a median outside is a wrong scale.
constexpr double kMedianMin = 0.12;  // [m]
constexpr double kMedianMax = 12.0;  // [m]
/// The optical axis passes this near to the middle of any real image, in shares of its size.
constexpr double kCentreMax = 0.11;
constexpr double kViewMin = 0.25;  // width of the image over focal length: 14 degrees
constexpr double kViewMax = 4.0;   // 127 degrees
constexpr double kAspectMax = 1.1;

[[noreturn]] void reject(const fs::path& file, const std::string& why) {
  throw core::ConfigError(file.string() + ": " + why);
}

enum class Format { none, png, pgm, tiff };

Format format_of(const std::string& head) {
  if (head.starts_with("\x89PNG\r\n")) return Format::png;
  if (head.starts_with("P5")) return Format::pgm;
  if (head.starts_with(std::string("II*\0", 4)) || head.starts_with(std::string("MM\0*", 4))) {
    return Format::tiff;
  }
  return Format::none;
}

/// A PGM decoder fills what is missing with zeros, so the size is compared beforehand.
void check_pgm(const fs::path& file, const std::string& bytes) {
  std::size_t at = 2;
  std::array<long, 3> numbers{};
  for (long& number : numbers) {
    for (bool skipping = true; skipping && at < bytes.size();) {
      skipping = std::isspace(static_cast<unsigned char>(bytes[at])) != 0 || bytes[at] == '#';
      if (bytes[at] == '#') at = std::min(bytes.find('\n', at), bytes.size());
      if (skipping) ++at;
    }
    int digits = 0;
    for (; at < bytes.size() && std::isdigit(static_cast<unsigned char>(bytes[at])) != 0; ++at) {
      if (++digits > 6) reject(file, "its PGM header is damaged");
      number = 10 * number + (bytes[at] - '0');
    }
    if (digits == 0) reject(file, "its PGM header is damaged");
  }
  if (numbers[2] <= 255) reject(file, "has 8 bits a pixel; depth images have 16");
  const std::uintmax_t data = 2U * static_cast<std::uintmax_t>(numbers[0] * numbers[1]);
  if (bytes.size() < at + 1 + data) {
    reject(file, "is cut short: " + std::to_string(numbers[0]) + "x" + std::to_string(numbers[1]) +
                     " pixels need " + std::to_string(data) + " bytes, there are " +
                     std::to_string(bytes.size() - std::min(bytes.size(), at + 1)));
  }
}

/// A PNG decoder hands over the rows before the damage as if nothing was; the end chunk tells.
void check_png(const fs::path& file, const std::string& bytes) {
  if (bytes.size() < 12 || bytes.find("IEND", bytes.size() - 12) == std::string::npos) {
    reject(file, "is cut short: the PNG has no end");
  }
}

std::array<double, 4> known_camera(const fs::path& file, const RawDepthImage& image) {
  const double width = image.width;
  const double height = image.height;
  if (image.width == 512 && image.height == 424) return {365.0, 365.0, 256.0, 212.0};  // Kinect v2
  if (3 * image.width == 4 * image.height) {  // D435 in its 4:3 modes
    const double focal = 385.0 * width / 640.0;
    return {focal, focal, 0.5 * width, 0.5 * height};
  }
  if (9 * image.width == 16 * image.height || image.width == 848) {  // D435 in its wide modes
    const double focal = 425.0 * width / 848.0;
    return {focal, focal, 0.5 * width, 0.5 * height};
  }
  reject(file, "no camera is known with " + std::to_string(image.width) + "x" +
                   std::to_string(image.height) + " pixels; give --intrinsics");
}

void check_intrinsics(const core::CameraIntrinsics& camera) {
  const auto refuse = [&](const std::string& rule) {
    throw core::ConfigError("--intrinsics do not fit an image of " + std::to_string(camera.width) +
                            "x" + std::to_string(camera.height) + ": " + rule);
  };
  for (const double value : {camera.fx, camera.fy, camera.cx, camera.cy}) {
    if (!std::isfinite(value)) refuse("all four must be numbers");
  }
  if (!(camera.fx > 0.0 && camera.fy > 0.0)) refuse("FX and FY must be positive");
  const double view = camera.width / camera.fx;
  if (view < kViewMin || view > kViewMax) {
    refuse("FX = " + std::to_string(camera.fx) + " pixels would be a view of " +
           std::to_string(2.0 * std::atan(0.5 * view) * 180.0 / 3.14159265) + " degrees");
  }
  const double aspect = camera.fx / camera.fy;
  if (aspect > kAspectMax || aspect < 1.0 / kAspectMax) refuse("FX and FY differ by over 10 %");
  if (std::abs(camera.cx - 0.5 * camera.width) > kCentreMax * camera.width ||
      std::abs(camera.cy - 0.5 * camera.height) > kCentreMax * camera.height) {
    refuse("CX, CY = " + std::to_string(camera.cx) + ", " + std::to_string(camera.cy) +
           " is not near the middle; are they of another image size?");
  }
}

void check_scale(const fs::path& file, const RawDepthImage& image, double metres_per_unit) {
  std::vector<std::uint16_t> measured;
  std::copy_if(image.values.begin(), image.values.end(), std::back_inserter(measured),
               [](std::uint16_t value) { return value > 0; });
  if (measured.empty()) reject(file, "no pixel holds a reading: all are 0");
  const auto middle = measured.begin() + static_cast<std::ptrdiff_t>(measured.size() / 2);
  std::nth_element(measured.begin(), middle, measured.end());
  const double median = *middle * metres_per_unit;
  if (median >= kMedianMin && median <= kMedianMax) return;
  char text[200];
  std::snprintf(text, sizeof text,
                "half of its pixels are beyond %.4g m with --depth-scale %g; depth cameras measure "
                "0.2 to 8 m. Is the unit right? (0.001 = the file counts millimetres)",
                median, metres_per_unit);
  reject(file, text);
}

}  // namespace

bool is_image_file(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::string head(8, '\0');
  stream.read(head.data(), static_cast<std::streamsize>(head.size()));
  return format_of(head) != Format::none;
}

RawDepthImage read_depth_image(const fs::path& file) {
  const std::string bytes = core::read_input_file(file, kLargest);
  const Format format = format_of(bytes);
  if (format == Format::none) reject(file, "is no PNG, PGM (P5) or TIFF");
  if (format == Format::pgm) check_pgm(file, bytes);
  if (format == Format::png) check_png(file, bytes);
  cv::utils::logging::setLogLevel(cv::utils::logging::LOG_LEVEL_SILENT);
  cv::Mat image;
  try {
    const cv::Mat buffer(1, static_cast<int>(bytes.size()), CV_8U,
                         const_cast<char*>(bytes.data()));  // read only, OpenCV has no const view
    image = cv::imdecode(buffer, cv::IMREAD_UNCHANGED);
  } catch (const cv::Exception&) {
    image.release();
  }
  if (image.empty()) reject(file, "cannot be decoded: it is damaged or cut short");
  if (image.type() != CV_16UC1) {
    reject(file, "has " + std::to_string(image.channels()) + " channel(s) of " +
                     std::to_string(8 * image.elemSize1()) +
                     " bits; a depth image has one channel of 16-bit whole numbers");
  }
  RawDepthImage result{.width = image.cols, .height = image.rows, .values = {}};
  for (int row = 0; row < image.rows; ++row) {
    const std::uint16_t* values = image.ptr<std::uint16_t>(row);
    result.values.insert(result.values.end(), values, values + image.cols);
  }
  return result;
}

core::DepthFrame depth_frame_of(const fs::path& file, const RawDepthImage& image,
                                const DepthScaling& scaling) {
  const std::array<double, 4> lens =
      scaling.intrinsics ? *scaling.intrinsics : known_camera(file, image);
  core::DepthFrame frame;
  frame.intrinsics = {image.width, image.height, lens[0], lens[1], lens[2], lens[3]};
  check_intrinsics(frame.intrinsics);
  check_scale(file, image, scaling.metres_per_unit);
  frame.depth.reserve(image.values.size());
  for (const std::uint16_t value : image.values) {
    frame.depth.push_back(static_cast<float>(value * scaling.metres_per_unit));
  }
  return frame;
}

}  // namespace hopscotch::apps
