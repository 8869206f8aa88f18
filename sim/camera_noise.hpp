#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/depth_frame.hpp"
#include "sim/depth_renderer.hpp"
#include "sim/random.hpp"

namespace hopscotch::sim {

/// Errors of an active stereo depth camera. The defaults are those of a D435 at 640x480: the
/// standard deviation and the correlation over pixels (0.95 at 1, 0.8 at 4, 0.5 at 8, 0.1 at 14)
/// are measured ones, the rates are chosen so that edges are about as ragged as in its images.
struct DepthNoiseModel {
  double sigma_floor = 0.001;         ///< Standard deviation at z = 0 [m].
  double sigma_growth = 0.0036;       ///< Growth of it with z^2 [1/m].
  int node_spacing = 12;              ///< Of the smooth part of the error [pixel].
  double white_share = 0.05;          ///< Share of the variance that is independent per pixel.
  double quantum = 0.001;             ///< Smallest step of the output [m].
  double baseline = 0.050;            ///< Between the two imagers: width of stereo shadows [m].
  double dropout_rate = 0.002;        ///< Pixels lost anywhere.
  double grazing_cosine_lost = 0.05;  ///< Cosine of incidence below which all pixels are lost.
  double grazing_cosine_safe = 0.20;  ///< Cosine of incidence above which none is.
  double edge_jump = 0.03;            ///< Step of depth that counts as an edge, relative to depth.
  int edge_width = 2;                 ///< Pixels on the far side of an edge that it disturbs.
  double edge_dropout_rate = 0.30;    ///< Share of these that is lost.
  double flying_rate = 0.30;          ///< Share of these that lands between the two surfaces.
};

/// Turns exact depth into what the sensor would report. Deterministic: the same seed, frame index
/// and image give the same bytes, in any order of frames.
class DepthNoise {
 public:
  DepthNoise(const DepthNoiseModel& model, const core::CameraIntrinsics& intrinsics,
             const DepthRange& range, std::uint64_t seed);

  /// @param frame_index Selects the frame's own errors.
  /// @param exact       As DepthRenderer draws it [m].
  /// @param[out] measured Same layout; 0 = no measurement [m].
  void apply(std::uint64_t frame_index, const std::vector<float>& exact,
             std::vector<float>& measured);

 private:
  struct Edge {
    int u;   ///< Pixel of the nearer surface.
    int v;   ///< Pixel of the nearer surface.
    int du;  ///< Step from there to the farther surface.
    int dv;  ///< Step from there to the farther surface.
  };

  void fill_tables();
  void invert(const std::vector<float>& exact);
  void interpolate_error(int v);
  void measure_row(int v, Random& random, const float* exact, float* measured) const;
  void hide_left_band(int v, float* measured) const;
  void find_edges(int v);
  void disturb_edges(int v, Random& random, const std::vector<float>& exact,
                     std::vector<float>& measured);
  void disturb_edge(const Edge& edge, Random& random, const std::vector<float>& exact,
                    std::vector<float>& measured) const;
  void cast_shadow(const Edge& edge, std::vector<float>& measured) const;
  [[nodiscard]] std::size_t pixel(int u, int v) const {
    return static_cast<std::size_t>(v * intrinsics_.width + u);
  }
  [[nodiscard]] const float* inverse_row(int v) const;

  DepthNoiseModel model_;
  core::CameraIntrinsics intrinsics_;
  DepthRange range_;
  std::uint64_t seed_;
  int node_columns_;
  int node_rows_;

  std::vector<float> white_;        ///< Per-pixel errors to draw rows from, in sigma.
  std::vector<float> lost_above_;   ///< Squared inverse cosines of incidence to draw rows from.
  std::vector<float> near_weight_;  ///< Of the node before a pixel, by position between nodes.
  std::vector<float> far_weight_;   ///< Of the node behind it.

  std::vector<float> nodes_;            ///< Smooth error of the frame at its nodes, in sigma.
  std::vector<float> node_row_;         ///< The same interpolated to the present row.
  std::vector<float> smooth_row_;       ///< The same at each pixel of the present row.
  std::vector<float> inverse_;          ///< 1/z with a rim of zeros one pixel wide [1/m].
  std::vector<std::uint8_t> edge_row_;  ///< Bit 0: edge to the right, bit 1: edge below.
};

}  // namespace hopscotch::sim
