#include "apps/report_pictures.hpp"

#include <algorithm>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "apps/html.hpp"
#include "apps/key_frames.hpp"

namespace hopscotch::apps {

namespace {

constexpr int kFrameWidth = 480;      // shown at about half of it [pixel]
constexpr int kCrossingWidth = 1600;  // [pixel]
constexpr std::size_t kMostFrames = 60;
constexpr int kJpegQuality = 82;

/// A picture file as `<img>`, made smaller if wider than `width`; empty if it cannot be read.
std::string embed(const std::filesystem::path& file, int width, const std::string& text) {
  if (!std::filesystem::exists(file)) return "";
  cv::Mat image = cv::imread(file.string(), cv::IMREAD_COLOR);
  if (image.empty()) return "";
  if (image.cols > width) {
    const int height = image.rows * width / image.cols;
    cv::resize(image, image, cv::Size(width, std::max(height, 1)), 0.0, 0.0, cv::INTER_AREA);
  }
  std::vector<unsigned char> bytes;
  cv::imencode(".jpg", image, bytes, {cv::IMWRITE_JPEG_QUALITY, kJpegQuality});
  return "<img alt=\"" + escape(text) + "\" width=\"" + std::to_string(image.cols) +
         "\" height=\"" + std::to_string(image.rows) + "\" src=\"data:image/jpeg;base64," +
         base64(bytes) + "\">";
}

/// "01-2-lift-off" is "Jump 1, lift-off"; other names stay as they are.
std::string frame_title(const std::string& stem) {
  const std::size_t first = stem.find('-');
  const std::size_t second = first == std::string::npos ? first : stem.find('-', first + 1);
  if (second == std::string::npos) return stem;
  const std::size_t digits = stem.find_first_not_of('0');
  return "Jump " + stem.substr(digits, first - digits) + ", " + stem.substr(second + 1);
}

}  // namespace

std::string embed_crossing_picture(const RunFolder& folder) {
  const std::string image = embed(folder.frames() / kCrossingPicture, kCrossingWidth,
                                  "The robot at several moments of the crossing, in one picture");
  return image.empty() ? "" : "<figure>" + image + "</figure>\n";
}

std::string embed_key_frames(const RunFolder& folder) {
  std::vector<std::filesystem::path> files;
  if (std::filesystem::is_directory(folder.frames())) {
    for (const auto& entry : std::filesystem::directory_iterator(folder.frames())) {
      const bool picture = entry.path().extension() == ".png";
      if (picture && entry.path().filename() != kCrossingPicture) files.push_back(entry.path());
    }
  }
  std::sort(files.begin(), files.end());
  files.resize(std::min(files.size(), kMostFrames));
  std::string html;
  for (const std::filesystem::path& file : files) {
    const std::string title = frame_title(file.stem().string());
    const std::string image = embed(file, kFrameWidth, title);
    if (image.empty()) continue;
    html += "<figure>" + image + "<figcaption>" + escape(title) + "</figcaption></figure>\n";
  }
  return html;
}

}  // namespace hopscotch::apps
