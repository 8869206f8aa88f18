#include "apps/scene_pictures.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <vector>

namespace hopscotch::apps {
namespace {

/// A camera 0.5 m above the soles that looks straight down at 0.5 m ahead of them; up in the image
/// is ahead.
class ScenePicture : public ::testing::Test {
 protected:
  ScenePicture() {
    X_WC_.translation() << 0.5, 0.0, 0.5;
    X_WC_.linear() << 0, -1, 0, -1, 0, 0, 0, 0, -1;
    frame_.intrinsics.width = frame_.intrinsics.height = kPixels;
    frame_.intrinsics.fx = frame_.intrinsics.fy = kFocal;
    frame_.intrinsics.cx = frame_.intrinsics.cy = 0.5 * kPixels;
    frame_.depth.assign(static_cast<std::size_t>(kPixels) * kPixels, 0.0F);
    report_.terrain.p_WS.setZero();
    report_.terrain.heading = 0.0;
  }
  void add_step_up(double x, double step) {
    core::OneStepTerrain& found = report_.survey.features;
    found.edges[found.edge_count++] = {
        .x = x, .sigma = 0.003, .step = step, .kind = core::EdgeKind::up};
  }
  /// Topmost row in which the line of an edge crosses the middle of the picture.
  int row_of_line() const {
    const auto file = std::filesystem::path(::testing::TempDir()) / "hopscotch-scene-picture.png";
    draw_over_depth(file, frame_, X_WC_, report_);
    const cv::Mat picture = cv::imread(file.string());
    std::filesystem::remove(file);
    for (int row = 0; row < picture.rows; ++row) {
      const auto& pixel = picture.at<cv::Vec3b>(row, kPixels / 2);
      if (pixel[1] > 200 && pixel[0] < 100) return row;
    }
    return -1;
  }
  /// Where a point ahead [m] at a height [m] is.
  static int row_of(double x, double z) {
    return static_cast<int>(0.5 * kPixels - kFocal * (x - 0.5) / (0.5 - z));
  }

  static constexpr int kPixels = 400;
  static constexpr double kFocal = 300.0;
  static constexpr int kThick = 3;
  core::DepthFrame frame_;
  Eigen::Isometry3d X_WC_ = Eigen::Isometry3d::Identity();
  TerrainReport report_;
};

TEST_F(ScenePicture, DrawsAnEdgeWhereItsTopIs) {
  add_step_up(0.6, 0.1);
  EXPECT_NEAR(row_of_line(), row_of(0.6, 0.1), kThick);
}

TEST_F(ScenePicture, AStepBehindTheSolesLiftsNothingAheadOfThem) {
  add_step_up(-0.6, 0.1);  // out of the picture
  add_step_up(0.7, 0.1);
  EXPECT_NEAR(row_of_line(), row_of(0.7, 0.1), kThick);
}

}  // namespace
}  // namespace hopscotch::apps
