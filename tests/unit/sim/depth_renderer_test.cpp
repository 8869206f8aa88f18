#include "sim/depth_renderer.hpp"

#include <gtest/gtest.h>
#include <mujoco/mujoco.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "sim/depth_scene.hpp"
#include "sim/mujoco_model.hpp"
#include "sim/scene_builder.hpp"

namespace hopscotch::sim {
namespace {

constexpr core::CameraIntrinsics kSmall{160, 120, 96.25, 96.25, 79.5, 59.5};
constexpr DepthRange kRange{};

/// Agreement that is asked for: single precision over metres is far better; only pixels whose ray
/// passes within rounding of an outline may fall on the other side of it.
constexpr double kSameDepth = 1e-3;  // [m]
constexpr double kSameShare = 0.999;

/// Ray casting by other means than the renderer's: triangles by solving the linear system of
/// barycentric coordinates, capsules by marching along the ray in steps of the free distance.
class RayCaster {
 public:
  RayCaster(const std::vector<Face>& faces, const std::vector<Capsule>& capsules)
      : faces_(faces), capsules_(capsules) {}

  /// Distance along `ray` in units of its length; infinity for a miss.
  [[nodiscard]] double cast(const Eigen::Vector3d& origin, const Eigen::Vector3d& ray) const {
    double nearest = std::numeric_limits<double>::infinity();
    for (const Face& face : faces_) {
      const auto& c = face.corners;
      nearest = std::min({nearest, triangle(origin, ray, c[0], c[1], c[2]),
                          triangle(origin, ray, c[0], c[2], c[3])});
    }
    return capsules_.empty() ? nearest : std::min(nearest, march(origin, ray, nearest));
  }

  /// From a point to the nearest capsule [m].
  [[nodiscard]] double free_distance(const Eigen::Vector3d& p) const {
    double free = std::numeric_limits<double>::infinity();
    for (const Capsule& capsule : capsules_) {
      const Eigen::Vector3d along = capsule.b - capsule.a;
      const double share = std::clamp(along.dot(p - capsule.a) / along.squaredNorm(), 0.0, 1.0);
      free = std::min(free, (p - capsule.a - share * along).norm() - capsule.radius);
    }
    return free;
  }

 private:
  static double triangle(const Eigen::Vector3d& origin, const Eigen::Vector3d& ray,
                         const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                         const Eigen::Vector3d& c) {
    Eigen::Matrix3d system;
    system << b - a, c - a, -ray;
    const Eigen::Vector3d solution = system.inverse() * (origin - a);
    const bool inside = solution[0] >= 0.0 && solution[1] >= 0.0 &&
                        solution[0] + solution[1] <= 1.0 && solution[2] > 0.0;
    return inside ? solution[2] : std::numeric_limits<double>::infinity();
  }

  [[nodiscard]] double march(const Eigen::Vector3d& origin, const Eigen::Vector3d& ray,
                             double limit) const {
    constexpr double kTouch = 1e-6;  // [m]
    const double length = ray.norm();
    double t = 0.0;
    while (t < std::min(limit, 10.0)) {
      const double free = free_distance(origin + t * ray);
      if (free < kTouch) return t;
      t += free / length;
    }
    return std::numeric_limits<double>::infinity();
  }

  std::vector<Face> faces_;
  std::vector<Capsule> capsules_;
};

Eigen::Vector3d pixel_ray(const core::CameraIntrinsics& camera, int u, int v) {
  return {(u - camera.cx) / camera.fx, (v - camera.cy) / camera.fy, 1.0};
}

float in_range(double z) {
  return z >= kRange.nearest && z <= kRange.farthest ? static_cast<float>(z) : 0.0F;
}

double same_share(const std::vector<float>& a, const std::vector<float>& b) {
  std::size_t same = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (std::abs(static_cast<double>(a[i] - b[i])) <= kSameDepth) ++same;
  }
  return static_cast<double>(same) / static_cast<double>(a.size());
}

std::vector<float> cast_image(const RayCaster& caster, const core::CameraIntrinsics& camera,
                              const Eigen::Isometry3d& X_WC) {
  std::vector<float> depth;
  for (int v = 0; v < camera.height; ++v) {
    for (int u = 0; u < camera.width; ++u) {
      const Eigen::Vector3d ray = X_WC.linear() * pixel_ray(camera, u, v);
      depth.push_back(in_range(caster.cast(X_WC.translation(), ray)));
    }
  }
  return depth;
}

class Dice {
 public:
  explicit Dice(unsigned seed) : engine_(seed) {}
  double between(double lowest, double highest) {
    return std::uniform_real_distribution<double>(lowest, highest)(engine_);
  }
  Eigen::Vector3d in_cube(double half) {
    return {between(-half, half), between(-half, half), between(-half, half)};
  }
  Eigen::Isometry3d pose(double reach) {
    Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
    X.translation() = in_cube(reach);
    X.linear() = Eigen::Quaterniond(between(-1.0, 1.0), between(-1.0, 1.0), between(-1.0, 1.0),
                                    between(-1.0, 1.0))
                     .normalized()
                     .toRotationMatrix();
    return X;
  }

 private:
  std::mt19937 engine_;
};

/// The camera's pose seen from a robot that stands, leans or flies over the terrain.
Eigen::Isometry3d view_from_trunk(Dice& dice) {
  Eigen::Isometry3d X_WB = Eigen::Isometry3d::Identity();
  X_WB.translation() =
      Eigen::Vector3d(dice.between(-0.2, 1.0), dice.between(-0.2, 0.2), dice.between(0.35, 0.9));
  X_WB.rotate(Eigen::AngleAxisd(dice.between(-0.6, 0.6), Eigen::Vector3d::UnitZ()));
  X_WB.rotate(Eigen::AngleAxisd(dice.between(-0.4, 0.6), Eigen::Vector3d::UnitY()));
  X_WB.rotate(Eigen::AngleAxisd(dice.between(-0.1, 0.1), Eigen::Vector3d::UnitX()));
  return X_WB * camera_mounting(CameraSettings{});
}

Terrain stepping_stones() {
  Terrain terrain;
  for (int i = 0; i < 6; ++i) {
    Slab slab;
    slab.centre = {0.45 * i, 0.0};
    slab.half_size = {0.15, 0.5};
    slab.top = 0.05 * (i % 3);
    slab.yaw = i == 3 ? 0.3 : 0.0;
    slab.slope = i == 4 ? 0.15 : 0.0;
    terrain.slabs.push_back(slab);
  }
  return terrain;
}

TEST(DepthRenderer, TerrainAgreesWithRayCasting) {
  const std::vector<Face> faces = terrain_faces(stepping_stones());
  const RayCaster caster(faces, {});
  DepthRenderer renderer(kSmall, kRange);
  Dice dice(11);
  for (int view = 0; view < 20; ++view) {
    const Eigen::Isometry3d X_WC = view_from_trunk(dice);
    std::vector<float> depth;
    renderer.render(faces, {}, X_WC, depth);
    EXPECT_GE(same_share(depth, cast_image(caster, kSmall, X_WC)), kSameShare) << "view " << view;
  }
}

void append_box_faces(const Eigen::Isometry3d& X_WO, const Eigen::Vector3d& half,
                      std::vector<Face>& faces) {
  for (int axis = 0; axis < 3; ++axis) {
    const Eigen::Vector3d along = Eigen::Vector3d::Unit((axis + 1) % 3).cwiseProduct(half);
    const Eigen::Vector3d across = Eigen::Vector3d::Unit((axis + 2) % 3).cwiseProduct(half);
    for (const double side : {-1.0, 1.0}) {
      const Eigen::Vector3d centre = side * Eigen::Vector3d::Unit(axis).cwiseProduct(half);
      faces.push_back({{X_WO * (centre - along - across), X_WO * (centre + along - across),
                        X_WO * (centre + along + across), X_WO * (centre - along + across)}});
    }
  }
}

/// Cameras anywhere, even inside boxes: clipping at the near plane, faces behind,
/// capsules across the camera's own plane.
TEST(DepthRenderer, ClutterAroundTheCameraAgreesWithRayCasting) {
  DepthRenderer renderer(kSmall, kRange);
  Dice dice(12);
  for (int view = 0; view < 20; ++view) {
    std::vector<Face> faces;
    for (int i = 0; i < 5; ++i) {
      append_box_faces(dice.pose(1.0), {dice.between(0.02, 0.5), 0.1, 0.2}, faces);
    }
    std::vector<Capsule> capsules;
    for (int i = 0; i < 6; ++i) {
      capsules.push_back({dice.in_cube(0.8), dice.in_cube(0.8), dice.between(0.01, 0.1)});
    }
    Eigen::Isometry3d X_WC = dice.pose(0.5);
    const RayCaster caster(faces, capsules);
    // The renderer cuts off what is nearer than 1 cm.
    while (caster.free_distance(X_WC.translation()) < 0.02) X_WC = dice.pose(0.5);
    std::vector<float> depth;
    renderer.render(faces, capsules, X_WC, depth);
    EXPECT_GE(same_share(depth, cast_image(caster, kSmall, X_WC)), kSameShare) << "view " << view;
  }
}

TEST(DepthRenderer, TerrainAgreesWithMujocoRays) {
  const model::RobotParameters robot =
      model::RobotParameters::load(HOPSCOTCH_SOURCE_DIR "/config/robots/hector.yaml");
  Terrain terrain = stepping_stones();
  for (Slab& slab : terrain.slabs) slab.slope = 0.0;  // MuJoCo's slopes have leaning side walls
  const ModelPointer world = compile_model(scene_mjcf(robot, terrain));
  const DataPointer data = make_data(*world);
  mj_forward(world.get(), data.get());
  const std::array<mjtByte, mjNGROUP> terrain_only{1, 0, 0, 0, 0, 0};

  const core::CameraIntrinsics camera = camera_intrinsics(CameraSettings{});
  DepthRenderer renderer(camera, kRange);
  Dice dice(13);
  int rays = 0;
  int same = 0;
  for (int view = 0; view < 5; ++view) {
    const Eigen::Isometry3d X_WC = view_from_trunk(dice);
    std::vector<float> depth;
    renderer.render(terrain_faces(terrain), {}, X_WC, depth);
    for (int v = 3; v < camera.height; v += 12) {
      for (int u = 3; u < camera.width; u += 12) {
        const Eigen::Vector3d ray = X_WC.linear() * pixel_ray(camera, u, v);
        int geom = -1;
        const double t = mj_ray(world.get(), data.get(), X_WC.translation().data(), ray.data(),
                                terrain_only.data(), 1, -1, &geom);
        const float expected = in_range(t);
        const float drawn = depth[static_cast<std::size_t>(v * camera.width + u)];
        ++rays;
        if (std::abs(drawn - expected) <= static_cast<float>(kSameDepth)) ++same;
      }
    }
  }
  EXPECT_GE(static_cast<double>(same) / rays, kSameShare);
}

TEST(DepthRenderer, PlaneAheadHasItsDistanceEverywhere) {
  DepthRenderer renderer(kSmall, kRange);
  const Face wall{{Eigen::Vector3d(-9, -9, 1.25), Eigen::Vector3d(9, -9, 1.25),
                   Eigen::Vector3d(9, 9, 1.25), Eigen::Vector3d(-9, 9, 1.25)}};
  std::vector<float> depth;
  renderer.render({&wall, 1}, {}, Eigen::Isometry3d::Identity(), depth);
  ASSERT_EQ(depth.size(), 160U * 120U);
  for (const float z : depth) ASSERT_NEAR(z, 1.25F, 1e-6F);
}

TEST(DepthRenderer, SphereAtTheEndOfACapsulePointsAtTheCamera) {
  DepthRenderer renderer({160, 120, 96.25, 96.25, 80.0, 60.0}, kRange);
  const Capsule pole{{0.0, 0.0, 1.0}, {0.0, 0.0, 2.0}, 0.1};
  std::vector<float> depth;
  renderer.render({}, {&pole, 1}, Eigen::Isometry3d::Identity(), depth);
  EXPECT_NEAR(depth[60U * 160U + 80U], 0.9F, 1e-5F);
}

TEST(DepthRenderer, EmptySceneMeasuresNothing) {
  DepthRenderer renderer(kSmall, kRange);
  std::vector<float> depth;
  renderer.render({}, {}, Eigen::Isometry3d::Identity(), depth);
  EXPECT_EQ(std::count(depth.begin(), depth.end(), 0.0F), 160 * 120);
}

TEST(DepthRenderer, WhatIsTooNearHidesWhatIsBehindAndIsNotMeasured) {
  DepthRenderer renderer(kSmall, kRange);
  std::vector<Face> faces;
  for (const double z : {0.1, 1.0}) {
    const double half = z == 0.1 ? 0.01 : 9.0;
    faces.push_back({{Eigen::Vector3d(-half, -half, z), Eigen::Vector3d(half, -half, z),
                      Eigen::Vector3d(half, half, z), Eigen::Vector3d(-half, half, z)}});
  }
  std::vector<float> depth;
  renderer.render(faces, {}, Eigen::Isometry3d::Identity(), depth);
  EXPECT_EQ(depth[60U * 160U + 80U], 0.0F);
  EXPECT_FLOAT_EQ(depth[0], 1.0F);
}

TEST(DepthRenderer, WhatIsBeyondTheRangeIsNotMeasured) {
  DepthRenderer renderer(kSmall, kRange);
  const double z = kRange.farthest + 0.01;
  const Face wall{{Eigen::Vector3d(-9, -9, z), Eigen::Vector3d(9, -9, z), Eigen::Vector3d(9, 9, z),
                   Eigen::Vector3d(-9, 9, z)}};
  std::vector<float> depth;
  renderer.render({&wall, 1}, {}, Eigen::Isometry3d::Identity(), depth);
  EXPECT_EQ(std::count(depth.begin(), depth.end(), 0.0F), 160 * 120);
}

}  // namespace
}  // namespace hopscotch::sim
