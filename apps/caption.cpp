#include "apps/caption.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace hopscotch::apps {

cv::Mat as_matrix(sim::RgbImage& image) {
  return {image.height, image.width, CV_8UC3, image.pixels.data()};
}

void write_caption(cv::Mat& picture, const std::string& text) {
  constexpr int kFont = cv::FONT_HERSHEY_SIMPLEX;
  constexpr double kDarken = 0.35;
  const double scale = picture.rows / 720.0;  // the sizes below suit that height
  const double letters = 0.8 * scale;
  const int thickness = std::max(1, static_cast<int>(std::lround(1.6 * scale)));
  const int pad = static_cast<int>(std::lround(14.0 * scale));
  int baseline = 0;
  const cv::Size size = cv::getTextSize(text, kFont, letters, thickness, &baseline);
  const cv::Rect strip(0, picture.rows - size.height - 2 * pad, size.width + 2 * pad,
                       size.height + 2 * pad);
  cv::Mat under = picture(strip & cv::Rect(0, 0, picture.cols, picture.rows));
  under *= kDarken;
  cv::putText(picture, text, {pad, picture.rows - pad}, kFont, letters, cv::Scalar(255, 255, 255),
              thickness, cv::LINE_AA);
}

}  // namespace hopscotch::apps
