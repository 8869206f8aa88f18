#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>

#include "core/robot_state.hpp"
#include "core/terrain_map.hpp"
#include "core/time.hpp"

namespace hopscotch::core {

/// Terrain along the jump line: frame S (origin: mid-point of the soles now, x along the heading,
/// z up). Heights are relative to that origin. Sample i lies at x = kStart + i kStep.
struct TerrainProfile {
  static constexpr int kSamples = 121;
  static constexpr double kStart = -0.30;  ///< [m]
  static constexpr double kStep = 0.015;   ///< [m]

  std::array<double, kSamples> lower{};  ///< Lowest support in the strip of the feet [m].
  std::array<double, kSamples> mean{};   ///< Mean support [m].
  std::array<double, kSamples> upper{};  ///< Nothing sticks out above this [m].
  std::array<CellState, kSamples> state{};

  static constexpr double x(int sample) { return kStart + sample * kStep; }
  /// Nearest sample, clamped to the ends; 0 for NaN.
  static constexpr int sample(double x) {
    const double position = (x - kStart) / kStep;
    if (!(position > 0.0)) return 0;
    // NOLINTNEXTLINE(bugprone-incorrect-roundings): positive here, and lround is not constexpr
    return position < kSamples - 1 ? static_cast<int>(position + 0.5) : kSamples - 1;
  }
};

enum class EdgeKind : std::uint8_t { up, down, gap_near, gap_far };

/// A height discontinuity across the jump line.
struct TerrainEdge {
  double x = kNaN;      ///< Position in S [m].
  double sigma = kNaN;  ///< Of x [m].
  double step = kNaN;   ///< Height behind minus height before [m].
  EdgeKind kind = EdgeKind::up;
};

/// A stretch without support.
struct TerrainGap {
  double near_x = kNaN;  ///< Last support before it, in S [m].
  double far_x = kNaN;   ///< First support behind it, in S [m].
  double sigma = kNaN;   ///< Of the width [m].
};

/// The one-step terrain product: what the next jump needs to know.
struct OneStepTerrain {
  static constexpr std::size_t kMaxFeatures = 12;

  Stamp stamp;                                             ///< Of the newest frame in it.
  Eigen::Vector3d p_WS = Eigen::Vector3d::Constant(kNaN);  ///< Origin of S [m].
  double heading = kNaN;                                   ///< Yaw of S in W [rad].
  TerrainProfile profile;
  std::array<TerrainEdge, kMaxFeatures> edges{};
  std::size_t edge_count = 0;
  std::array<TerrainGap, kMaxFeatures> gaps{};
  std::size_t gap_count = 0;
  double coverage = 0.0;  ///< Observed share of the profile ahead of the toes, 0 to 1.
};

}  // namespace hopscotch::core
