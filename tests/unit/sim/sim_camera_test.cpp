#include "sim/sim_camera.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "sim/depth_scene.hpp"

namespace hopscotch::sim {
namespace {

constexpr std::int64_t kTick = 1'000'000;  // [ns]

model::RobotParameters hector() {
  return model::RobotParameters::load(HOPSCOTCH_SOURCE_DIR "/config/robots/hector.yaml");
}

CameraSettings small_camera(CameraNoise noise) {
  CameraSettings settings;
  settings.noise = noise;
  settings.width = 64;
  settings.height = 48;
  return settings;
}

Terrain wide_floor() {
  Terrain terrain;
  terrain.slabs.push_back({.centre = {0.0, 0.0}, .half_size = {20.0, 20.0}, .top = 0.0});
  return terrain;
}

/// The usual stance: flat feet on z = 0, level trunk.
core::RobotState stance(core::Stamp stamp) {
  constexpr double kBend = 0.25 * 3.14159265358979;
  core::RobotState state;
  state.stamp = stamp;
  state.p_WB = Eigen::Vector3d(0.0, 0.0, 0.5481);
  state.R_WB.setIdentity();
  state.q << 0.0, 0.0, kBend, -2.0 * kBend, kBend, 0.0, 0.0, kBend, -2.0 * kBend, kBend;
  return state;
}

std::vector<core::DepthFrame> run(SimCamera& camera, int ticks) {
  std::vector<core::DepthFrame> frames;
  for (int tick = 0; tick < ticks; ++tick) {
    const core::Stamp now{tick * kTick};
    camera.expose(stance(now));
    while (auto frame = camera.poll(now)) frames.push_back(*frame);
  }
  return frames;
}

TEST(SimCamera, ExposesAtItsRate) {
  SimCamera camera(small_camera(CameraNoise::none), hector(), wide_floor(), 1);
  const std::vector<core::DepthFrame> frames = run(camera, 1041);
  ASSERT_EQ(frames.size(), 31U);  // 0, 1/30, ... 1 s; the last arrives at 1.040 s
  for (std::size_t k = 0; k < frames.size(); ++k) {
    const double due_ms = static_cast<double>(k) * 1000.0 / 30.0;
    EXPECT_EQ(frames[k].stamp.nanoseconds,
              static_cast<std::int64_t>(std::ceil(due_ms - 1e-6)) * kTick);
  }
}

TEST(SimCamera, DeliversExactlyOneLatencyAfterExposure) {
  SimCamera camera(small_camera(CameraNoise::none), hector(), wide_floor(), 1);
  camera.expose(stance({0}));
  EXPECT_FALSE(camera.poll({40 * kTick - 1}).has_value());
  const std::optional<core::DepthFrame> frame = camera.poll({40 * kTick});
  ASSERT_TRUE(frame.has_value());
  EXPECT_EQ(frame->stamp.nanoseconds, 0);
  EXPECT_FALSE(camera.poll({80 * kTick}).has_value());
}

TEST(SimCamera, KeepsFramesInFlightInOrder) {
  CameraSettings settings = small_camera(CameraNoise::none);
  settings.latency = 0.1;  // three periods
  SimCamera camera(settings, hector(), wide_floor(), 1);
  for (int tick = 0; tick < 100; ++tick) camera.expose(stance({tick * kTick}));
  EXPECT_FALSE(camera.poll({99 * kTick}).has_value());
  std::vector<std::int64_t> stamps;
  while (const auto frame = camera.poll({200 * kTick})) stamps.push_back(frame->stamp.nanoseconds);
  EXPECT_EQ(stamps, (std::vector<std::int64_t>{0, 34 * kTick, 67 * kTick}));
}

TEST(SimCamera, MissedExposuresAreNotMadeUpFor) {
  SimCamera camera(small_camera(CameraNoise::none), hector(), wide_floor(), 1);
  camera.expose(stance({500 * kTick}));
  camera.expose(stance({501 * kTick}));
  EXPECT_TRUE(camera.poll({2000 * kTick}).has_value());
  EXPECT_FALSE(camera.poll({2000 * kTick}).has_value());
}

TEST(SimCamera, ShowsThePoseAtExposureNotAtDelivery) {
  SimCamera camera(small_camera(CameraNoise::none), hector(), wide_floor(), 1);
  camera.expose(stance({0}));
  core::RobotState higher = stance({kTick});
  higher.p_WB.z() += 0.3;
  camera.expose(higher);
  const std::optional<core::DepthFrame> frame = camera.poll({40 * kTick});
  ASSERT_TRUE(frame.has_value());
  // Every pixel of the flat floor, put back into W with the pose at exposure, has height zero.
  const core::CameraIntrinsics& c = frame->intrinsics;
  Eigen::Isometry3d X_WB = Eigen::Isometry3d::Identity();
  X_WB.translation() = stance({0}).p_WB;
  int floor = 0;
  for (int v = 0; v < c.height; ++v) {
    for (int u = 0; u < c.width; ++u) {
      const double z = static_cast<double>(frame->depth[static_cast<std::size_t>(v * c.width + u)]);
      if (z == 0.0) continue;
      const Eigen::Vector3d p_C = z * Eigen::Vector3d((u - c.cx) / c.fx, (v - c.cy) / c.fy, 1.0);
      const Eigen::Vector3d p_W = X_WB * frame->X_BC * p_C;
      if (p_W.x() < 0.15) continue;  // own feet
      ASSERT_NEAR(p_W.z(), 0.0, 1e-5);
      ++floor;
    }
  }
  EXPECT_GT(floor, 1000);
}

TEST(SimCamera, LosesItsShareOfFramesAndPixels) {
  CameraSettings settings = small_camera(CameraNoise::none);
  const auto valid = [](const core::DepthFrame& frame) {
    return std::count_if(frame.depth.begin(), frame.depth.end(), [](float z) { return z > 0.0F; });
  };
  SimCamera whole(settings, hector(), wide_floor(), 1);
  const std::vector<core::DepthFrame> all = run(whole, 10040);
  settings.lost_frames = 0.3;
  settings.lost_pixels = 0.4;
  SimCamera faulty(settings, hector(), wide_floor(), 1);
  const std::vector<core::DepthFrame> some = run(faulty, 10040);
  EXPECT_NEAR(static_cast<double>(some.size()), 0.7 * static_cast<double>(all.size()), 30.0);
  double share = 0.0;
  for (const core::DepthFrame& frame : some) {
    share += static_cast<double>(valid(frame)) / static_cast<double>(valid(all.front())) /
             static_cast<double>(some.size());
  }
  EXPECT_NEAR(share, 0.6, 0.03);
  EXPECT_NE(some[0].depth, some[1].depth);  // others in each frame
}

TEST(SimCamera, ErrorsOfTimeAndMountingAreNotTold) {
  CameraSettings settings = small_camera(CameraNoise::none);
  SimCamera right(settings, hector(), wide_floor(), 1);
  settings.time_error = 0.03;
  settings.pitch_error = 0.02;
  SimCamera wrong(settings, hector(), wide_floor(), 1);
  const core::DepthFrame told = run(right, 41).front();
  const core::DepthFrame frame = run(wrong, 41).front();
  EXPECT_EQ(frame.stamp.nanoseconds, told.stamp.nanoseconds + 30 * kTick);
  EXPECT_TRUE(frame.X_BC.isApprox(told.X_BC));
  const std::size_t middle = frame.depth.size() / 2 + 32;
  EXPECT_LT(frame.depth[middle], told.depth[middle] - 0.003F);  // it looks further down
}

TEST(SimCamera, SeesItsOwnFeetWhenItLooksAtThem) {
  CameraSettings settings;
  settings.noise = CameraNoise::none;
  settings.pitch = 1.5;
  SimCamera camera(settings, hector(), wide_floor(), 1);
  camera.expose(stance({0}));
  const std::optional<core::DepthFrame> frame = camera.poll({40 * kTick});
  ASSERT_TRUE(frame.has_value());
  core::RobotState state = stance({0});
  Eigen::Isometry3d X_WB = Eigen::Isometry3d::Identity();
  X_WB.translation() = state.p_WB;
  const Eigen::Isometry3d X_CW = (X_WB * frame->X_BC).inverse();
  const std::vector<Capsule> capsules = leg_capsules(hector(), state);
  for (const std::size_t foot : {2U, 5U}) {
    const Eigen::Vector3d toe = X_CW * capsules[foot].b;
    const core::CameraIntrinsics& c = frame->intrinsics;
    const int u = static_cast<int>(std::lround(c.fx * toe.x() / toe.z() + c.cx));
    const int v = static_cast<int>(std::lround(c.fy * toe.y() / toe.z() + c.cy));
    ASSERT_TRUE(u >= 0 && v >= 0 && u < c.width && v < c.height);
    const float seen = frame->depth[static_cast<std::size_t>(v * c.width + u)];
    // The top of the foot, one radius before its axis; a pixel is 1.5 mm wide there.
    EXPECT_NEAR(static_cast<double>(seen), toe.z() - capsules[foot].radius, 0.001);
  }
}

TEST(SimCamera, SameSeedGivesTheSameBytes) {
  const auto depth_of = [](std::uint64_t seed) {
    SimCamera camera(small_camera(CameraNoise::d435), hector(), wide_floor(), seed);
    return run(camera, 200).back().depth;
  };
  EXPECT_EQ(depth_of(3), depth_of(3));
  EXPECT_NE(depth_of(3), depth_of(4));
}

TEST(SimCamera, NoiseChangesFromFrameToFrame) {
  SimCamera camera(small_camera(CameraNoise::d435), hector(), wide_floor(), 3);
  const std::vector<core::DepthFrame> frames = run(camera, 120);
  ASSERT_GE(frames.size(), 2U);
  EXPECT_NE(frames[0].depth, frames[1].depth);
}

}  // namespace
}  // namespace hopscotch::sim
