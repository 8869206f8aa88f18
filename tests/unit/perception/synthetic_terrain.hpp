#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "core/config_reader.hpp"
#include "core/depth_frame.hpp"
#include "core/robot_state.hpp"
#include "model/robot_parameters.hpp"
#include "model/stand_posture.hpp"
#include "perception/one_step.hpp"
#include "perception/perception_config.hpp"
#include "perception/terrain_mapper.hpp"

/// A small world of blocks, seen by a small ray caster: perception is tested without the simulator.
namespace hopscotch::test {

/// A block with a level top, in the course's own frame (x along the course).
struct Block {
  double start = 0.0;  ///< x [m]
  double end = 0.0;    ///< x [m]
  double top = 0.0;    ///< z [m]
  double half_width = 0.6;
};

struct Course {
  std::vector<Block> blocks{};
  double pit_depth = 0.5;
  /// Turns the course (and the robot with it) about the vertical of W.
  double yaw = 0.0;
};

inline core::ConfigReader tuning() {
  return core::ConfigReader::from_file(std::string(HOPSCOTCH_SOURCE_DIR) +
                                       "/config/hopscotch.yaml");
}

inline model::RobotParameters hector() {
  return model::RobotParameters::load(std::string(HOPSCOTCH_SOURCE_DIR) +
                                      "/config/robots/hector.yaml");
}

inline perception::PerceptionConfig perception_config() {
  return perception::PerceptionConfig::load(tuning().section("perception"));
}

/// Standing still with the mid-point of the soles at `x` along the course, on ground of `height`.
inline core::RobotState standing_at(const Course& course, double x, double height, double time) {
  const model::RobotParameters robot = hector();
  const model::StandPose pose = *model::stand_pose(
      robot, model::StandPosture::load(tuning().section("model").section("stand_posture")));
  const Eigen::AngleAxisd turn(course.yaw, Eigen::Vector3d::UnitZ());
  core::RobotState state;
  state.stamp = core::Stamp::from_seconds(time);
  state.p_WB = turn * Eigen::Vector3d(x + pose.trunk_x, 0.0, height + pose.trunk_height);
  state.R_WB =
      (turn * Eigen::AngleAxisd(pose.trunk_pitch, Eigen::Vector3d::UnitY())).toRotationMatrix();
  state.v_WB.setZero();
  state.w_WB.setZero();
  state.q = pose.q;
  state.dq.setZero();
  state.contact = {true, true};
  return state;
}

/// The camera of the scenario defaults: 9 cm ahead of and 8 cm above B, pitched down by 0.60 rad.
inline core::DepthFrame empty_frame(int width, int height, double time) {
  core::DepthFrame frame;
  frame.stamp = core::Stamp::from_seconds(time);
  const double focal = 385.0 * width / 640.0;
  frame.intrinsics = {width, height, focal, focal, 0.5 * width, 0.5 * height};
  Eigen::Matrix3d R_BC;  // columns: x right, y down, z forward
  R_BC << 0.0, 0.0, 1.0, -1.0, 0.0, 0.0, 0.0, -1.0, 0.0;
  frame.X_BC.linear() = Eigen::AngleAxisd(0.60, Eigen::Vector3d::UnitY()).toRotationMatrix() * R_BC;
  frame.X_BC.translation() = Eigen::Vector3d(0.09, 0.0, 0.08);
  frame.depth.assign(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), 0.0F);
  return frame;
}

/// Distance along `ray` from `from` to an upright box, infinity if missed.
inline double hit_box(const Eigen::Vector3d& low, const Eigen::Vector3d& high,
                      const Eigen::Vector3d& from, const Eigen::Vector3d& ray) {
  double enter = 0.0;
  double leave = std::numeric_limits<double>::infinity();
  for (int axis = 0; axis < 3; ++axis) {
    const double a = (low(axis) - from(axis)) / ray(axis);
    const double b = (high(axis) - from(axis)) / ray(axis);
    enter = std::max(enter, std::min(a, b));
    leave = std::min(leave, std::max(a, b));
  }
  return enter <= leave ? enter : std::numeric_limits<double>::infinity();
}

/// Exact depth image of the course.
inline core::DepthFrame render(const Course& course, const core::RobotState& state, int width = 640,
                               int height = 480) {
  core::DepthFrame frame = empty_frame(width, height, state.stamp.seconds());
  Eigen::Isometry3d X_WB = Eigen::Isometry3d::Identity();
  X_WB.linear() = state.R_WB;
  X_WB.translation() = state.p_WB;
  const Eigen::AngleAxisd back(-course.yaw, Eigen::Vector3d::UnitZ());
  const Eigen::Isometry3d X_TC = back * (X_WB * frame.X_BC);  // T: course
  const core::CameraIntrinsics& lens = frame.intrinsics;
  for (int v = 0; v < height; ++v) {
    for (int u = 0; u < width; ++u) {
      const Eigen::Vector3d ray =
          X_TC.linear() * Eigen::Vector3d((u - lens.cx) / lens.fx, (v - lens.cy) / lens.fy, 1.0);
      double depth = (-course.pit_depth - X_TC.translation().z()) / ray.z();
      if (depth < 0.0) depth = std::numeric_limits<double>::infinity();
      for (const Block& block : course.blocks) {
        depth = std::min(
            depth, hit_box({block.start, -block.half_width, -course.pit_depth},
                           {block.end, block.half_width, block.top}, X_TC.translation(), ray));
      }
      if (depth < 3.0) {
        frame.depth[static_cast<std::size_t>(v * width + u)] = static_cast<float>(depth);
      }
    }
  }
  return frame;
}

/// Makes an exact image look like that of a stereo camera: errors of 1 mm + 3.6 mm/m^2 z^2 that are
/// alike over a dozen pixels, readings in whole millimetres, lost pixels, and behind depth edges
/// two pixels that are lost or lie between the surfaces.
inline void add_noise(core::DepthFrame& frame, std::uint32_t seed) {
  constexpr int kNodeSpacing = 12;
  std::mt19937 random(seed);
  std::normal_distribution<float> normal;
  std::uniform_real_distribution<float> uniform(0.0F, 1.0F);
  const int width = frame.intrinsics.width;
  const int height = frame.intrinsics.height;
  const int nodes_x = width / kNodeSpacing + 2;
  const int nodes_y = height / kNodeSpacing + 2;
  std::vector<float> nodes(static_cast<std::size_t>(nodes_x * nodes_y));
  for (float& node : nodes) node = normal(random);
  const std::vector<float> exact = frame.depth;
  const auto pixel = [width](int u, int v) { return static_cast<std::size_t>(v * width + u); };
  for (int v = 0; v < height; ++v) {
    for (int u = 0; u < width; ++u) {
      float& z = frame.depth[pixel(u, v)];
      if (z == 0.0F) continue;
      const int nu = u / kNodeSpacing;
      const int nv = v / kNodeSpacing;
      const float a = static_cast<float>(u % kNodeSpacing) / kNodeSpacing;
      const float b = static_cast<float>(v % kNodeSpacing) / kNodeSpacing;
      const auto node = [&](int x, int y) {
        return nodes[static_cast<std::size_t>(y * nodes_x + x)];
      };
      const float smooth = (1 - b) * ((1 - a) * node(nu, nv) + a * node(nu + 1, nv)) +
                           b * ((1 - a) * node(nu, nv + 1) + a * node(nu + 1, nv + 1));
      const float scale = std::sqrt(((1 - a) * (1 - a) + a * a) * ((1 - b) * (1 - b) + b * b));
      const float sigma = 0.001F + 0.0036F * z * z;
      z += sigma * (0.97F * smooth / scale + 0.22F * normal(random));
      for (const int du : {-2, -1, 1, 2}) {  // behind an edge
        if (u + du < 0 || u + du >= width) continue;
        const float other = exact[pixel(u + du, v)];
        if (other > 0.0F && other < 0.97F * exact[pixel(u, v)] && uniform(random) < 0.4F) {
          z = uniform(random) < 0.5F ? 0.0F : other + uniform(random) * (z - other);
        }
      }
      for (const int dv : {-2, -1, 1, 2}) {
        if (v + dv < 0 || v + dv >= height) continue;
        const float other = exact[pixel(u, v + dv)];
        if (other > 0.0F && other < 0.97F * exact[pixel(u, v)] && uniform(random) < 0.4F) {
          z = uniform(random) < 0.5F ? 0.0F : other + uniform(random) * (z - other);
        }
      }
      if (uniform(random) < 0.002F) z = 0.0F;
      z = 0.001F * std::round(1000.0F * z);
    }
  }
}

/// Looks at the course for `frames` noisy frames from one place, at 30 Hz from `time` on.
inline void look(const Course& course, const core::RobotState& state, int frames,
                 std::uint32_t seed, perception::TerrainMapper& mapper) {
  const core::DepthFrame exact = render(course, state);
  for (int i = 0; i < frames; ++i) {
    core::DepthFrame frame = exact;
    frame.stamp = state.stamp.after(i / 30.0);
    add_noise(frame, seed + static_cast<std::uint32_t>(i));
    mapper.integrate(frame, state);
  }
}

/// The one-step product from where the robot stands.
inline core::OneStepTerrain preview(const perception::TerrainMapper& mapper,
                                    const core::RobotState& state) {
  const perception::OneStepConfig config = perception_config().one_step;
  return perception::one_step_terrain(config, mapper.map(),
                                      perception::stance_pose(config, hector(), state));
}

/// Top of the course at a place in its own frame; the pit where there is no block.
inline double top_at(const Course& course, double x, double y) {
  for (const Block& block : course.blocks) {
    if (x >= block.start && x <= block.end && std::abs(y) <= block.half_width) return block.top;
  }
  return -course.pit_depth;
}

}  // namespace hopscotch::test
