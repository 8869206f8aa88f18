#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstdint>
#include <random>
#include <vector>

#include "sim/terrain.hpp"

/// Random worlds whose truth is known: treads with steps and gaps across the way of the robot.
namespace hopscotch::accuracy {

struct TrueTread {
  double start = 0.0;  ///< [m]
  double end = 0.0;    ///< [m]
  double top = 0.0;    ///< [m]
};

struct TrueEdge {
  double x = 0.0;      ///< [m]
  double step = 0.0;   ///< Behind less before; of the treads on either side [m].
  double width = 0.0;  ///< Of the gap that begins or ends there; 0: a step.
  bool far_side = false;
};

/// Treads along x, all 2.4 m wide; the robot stands with its soles about the origin.
struct RandomWorld {
  std::vector<TrueTread> treads;

  explicit RandomWorld(std::uint64_t seed) {
    std::mt19937_64 random(seed * 0x9E3779B97F4A7C15U + 1);
    const auto between = [&](double low, double high) {
      return std::uniform_real_distribution<double>(low, high)(random);
    };
    double x = between(0.12, 0.55);
    double top = 0.0;
    treads.push_back({-1.0, x, top});
    while (x < 2.6) {
      const double kind = between(0.0, 1.0);
      double gap = 0.0;
      double step = 0.0;
      if (kind < 0.7) gap = between(0.05, 0.25);
      if (kind > 0.3) {
        step = between(0.035, 0.08) * (between(0.0, 1.0) < 0.5 ? -1.0 : 1.0);
      } else if (between(0.0, 1.0) < 0.5) {
        step = between(-0.02, 0.02);  // too low for an edge of its own
      }
      if (gap == 0.0 && std::abs(step) < 0.03) continue;
      const double length = between(0.24, 0.60);
      top += step;
      x += gap;
      treads.push_back({x, x + length, top});
      x += length;
    }
  }

  [[nodiscard]] sim::Terrain terrain() const {
    sim::Terrain terrain;
    for (const TrueTread& tread : treads) {
      sim::Slab slab;
      slab.centre = {0.5 * (tread.start + tread.end), 0.0};
      slab.half_size = {0.5 * (tread.end - tread.start), 1.2};
      slab.top = tread.top;
      terrain.slabs.push_back(slab);
    }
    return terrain;
  }

  [[nodiscard]] const TrueTread* at(double x) const {
    const auto found = std::find_if(treads.begin(), treads.end(), [x](const TrueTread& tread) {
      return x >= tread.start && x <= tread.end;
    });
    return found == treads.end() ? nullptr : &*found;
  }

  [[nodiscard]] std::vector<TrueEdge> edges() const {
    std::vector<TrueEdge> edges;
    for (std::size_t i = 0; i + 1 < treads.size(); ++i) {
      const double width = treads[i + 1].start - treads[i].end;
      const double step = treads[i + 1].top - treads[i].top;
      edges.push_back({treads[i].end, step, width, false});
      if (width > 0.0) edges.push_back({treads[i + 1].start, step, width, true});
    }
    return edges;
  }

  /// Distance of the nearest place where support ends or changes height from [from, to]; negative
  /// when it lies within. A place over a gap gives the most negative.
  [[nodiscard]] double spare(double from, double to) const {
    const TrueTread* tread = at(0.5 * (from + to));
    if (tread == nullptr) return -1.0;
    return std::min(from - tread->start, tread->end - to);
  }

  /// Whether a ray from a camera to a point of the ground passes over all treads before it.
  [[nodiscard]] bool is_visible(const Eigen::Vector2d& camera, double x) const {
    const TrueTread* tread = at(x);
    if (tread == nullptr) return false;
    for (const TrueTread& other : treads) {
      if (&other == tread || other.end > x) continue;
      const double share = (other.end - camera.x()) / (x - camera.x());
      const double ray = camera.y() + share * (tread->top - camera.y());
      if (share > 0.0 && ray < other.top) return false;
    }
    return true;
  }
};

}  // namespace hopscotch::accuracy
