#include "perception/camera_calibration.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "perception/depth_noise.hpp"
#include "tests/unit/perception/synthetic_terrain.hpp"

namespace hopscotch::perception {
namespace {

using Eigen::Vector3d;

/// How the camera really sits and ticks, against what is believed.
struct Truth {
  double x = 0.0;
  double z = 0.0;
  double roll = 0.0;
  double pitch = 0.0;
  double time_offset = 0.0;
};

/// The trunk crouching and leaning; amplitude 0 stands still.
TrunkSample trunk_at(double t, double amplitude) {
  constexpr double kRate = 7.0;  // [rad/s], about one crouch a second
  TrunkSample trunk{.stamp = core::Stamp::from_seconds(t)};
  const double pitch = 0.2 + 0.3 * amplitude * std::sin(kRate * t);
  const double pitch_rate = 0.3 * amplitude * kRate * std::cos(kRate * t);
  trunk.X_GB.translation() = Vector3d(0.05 * amplitude * std::sin(0.7 * kRate * t), 0.0,
                                      0.5 + 0.06 * amplitude * std::sin(1.3 * kRate * t));
  trunk.v_GB = Vector3d(0.05 * amplitude * 0.7 * kRate * std::cos(0.7 * kRate * t), 0.0,
                        0.06 * amplitude * 1.3 * kRate * std::cos(1.3 * kRate * t));
  trunk.X_GB.linear() = Eigen::AngleAxisd(pitch, Vector3d::UnitY()).toRotationMatrix();
  trunk.w_GB = Vector3d(0.0, pitch_rate, 0.0);
  return trunk;
}

/// Two seconds of frames over level ground, recorded by a camera that differs from the belief.
CalibrationData record(const Truth& truth, double amplitude, std::uint32_t seed) {
  const PerceptionConfig config = test::perception_config();
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  CalibrationData data;
  data.X_BC = test::empty_frame(320, 240, 0.0).X_BC;
  Eigen::Isometry3d X_BC = data.X_BC;
  const Vector3d turn(truth.roll, truth.pitch, 0.0);
  if (turn.norm() > 0.0) {
    X_BC.linear() = Eigen::AngleAxisd(turn.norm(), turn.normalized()) * X_BC.linear();
  }
  X_BC.translation() += Vector3d(truth.x, 0.0, truth.z);
  for (double t = -0.2; t < 2.2; t += 0.002) data.trunk.push_back(trunk_at(t, amplitude));
  for (int k = 0; k < 60; ++k) {
    const double t = k / 30.0;
    const Eigen::Isometry3d X_GC = trunk_at(t, amplitude).X_GB * X_BC;
    CalibrationFrame frame;
    frame.stamp = core::Stamp::from_seconds(t - truth.time_offset);
    for (int v = 24; v < 480; v += 48) {
      for (int u = 24; u < 640; u += 48) {
        const Vector3d ray((u - 320) / 385.0, (v - 240) / 385.0, 1.0);
        const Vector3d ray_G = X_GC.linear() * ray;
        if (ray_G.z() > -0.1) continue;
        const double depth = -X_GC.translation().z() / ray_G.z();
        if (depth < 0.25 || depth > 2.2) continue;
        const double sigma = depth_sigma(config.noise, depth);
        frame.points_C.emplace_back((depth + sigma * normal(random)) * ray);
        frame.sigmas.push_back(sigma);
      }
    }
    data.frames.push_back(frame);
  }
  return data;
}

TEST(CameraCalibration, FindsTwentyRandomMountingsAndOffsets) {
  const CalibrationConfig config = test::perception_config().calibration;
  std::mt19937 random(11);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  for (std::uint32_t log = 0; log < 20; ++log) {
    const Truth truth{.x = 0.01 * unit(random),
                      .z = 0.01 * unit(random),
                      .roll = 0.02 * unit(random),
                      .pitch = 0.02 * unit(random),
                      .time_offset = 0.02 * unit(random)};
    const CalibrationData data = record(truth, 1.0, 100U + log);
    const auto result = calibrate_camera(config, data);
    ASSERT_TRUE(result) << result.error().sentence;
    const Vector3d moved = result->X_BC.translation() - data.X_BC.translation();
    EXPECT_NEAR(moved.x(), truth.x, 0.002) << "log " << log;
    EXPECT_NEAR(moved.z(), truth.z, 0.002) << "log " << log;
    const Eigen::AngleAxisd turned(result->X_BC.linear() * data.X_BC.linear().transpose());
    const Vector3d turn = turned.angle() * turned.axis();
    constexpr double kAngle = 0.0035;  // 0.2 degrees
    EXPECT_NEAR(turn.x(), truth.roll, kAngle) << "log " << log;
    EXPECT_NEAR(turn.y(), truth.pitch, kAngle) << "log " << log;
    EXPECT_NEAR(result->time_offset, truth.time_offset, 0.003) << "log " << log;
  }
}

TEST(CameraCalibration, RefusesALogWithoutMotion) {
  const auto result = calibrate_camera(test::perception_config().calibration, record({}, 0.0, 5U));
  ASSERT_FALSE(result);
  EXPECT_NE(result.error().sentence.find("does not determine"), std::string::npos)
      << result.error().sentence;
}

TEST(CameraCalibration, RefusesALogWithoutGround) {
  CalibrationData data = record({}, 1.0, 5U);
  for (TrunkSample& trunk : data.trunk) trunk.X_GB.translation().z() += 0.4;
  const auto result = calibrate_camera(test::perception_config().calibration, data);
  ASSERT_FALSE(result);
  EXPECT_NE(result.error().sentence.find("points"), std::string::npos);
}

}  // namespace
}  // namespace hopscotch::perception
