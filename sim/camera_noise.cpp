#include "sim/camera_noise.hpp"

#include <algorithm>
#include <cmath>

#include "core/check.hpp"

namespace hopscotch::sim {
namespace {

/// Rows draw their independent errors from a window of a table; this many windows differ.
constexpr double kWindows = 8192;

constexpr std::uint8_t kEdgeRight = 1;
constexpr std::uint8_t kEdgeBelow = 2;

/// Keeps the camera's random numbers apart from those of the plant under the same seed.
constexpr std::uint64_t kCameraSeed = 0x63616d657261;  // "camera"

/// In [0, 1).
double share(Random& random) {
  return 0.5 * (random.uniform() + 1.0);
}

/// Start of one of the windows of a table.
std::size_t window(Random& random) {
  return static_cast<std::size_t>(share(random) * kWindows);
}

void fill_normal(Random& random, std::vector<float>& values) {
  for (float& value : values) value = static_cast<float>(random.normal());
}

}  // namespace

DepthNoise::DepthNoise(const DepthNoiseModel& model, const core::CameraIntrinsics& intrinsics,
                       const DepthRange& range, std::uint64_t seed)
    : model_(model),
      intrinsics_(intrinsics),
      range_(range),
      seed_(seed ^ kCameraSeed),
      node_columns_(intrinsics.width / model.node_spacing + 2),
      node_rows_(intrinsics.height / model.node_spacing + 2) {
  HOPSCOTCH_CHECK(intrinsics.width > 0 && intrinsics.height > 0 && model.node_spacing > 0);
  const std::size_t columns = static_cast<std::size_t>(intrinsics.width);
  const std::size_t rows = static_cast<std::size_t>(intrinsics.height);
  const std::size_t spacing = static_cast<std::size_t>(model.node_spacing);
  white_.resize(static_cast<std::size_t>(kWindows) + columns);
  lost_above_.resize(static_cast<std::size_t>(kWindows) + columns);
  near_weight_.resize(spacing);
  far_weight_.resize(spacing);
  node_row_.resize(static_cast<std::size_t>(node_columns_));
  nodes_.resize(node_row_.size() * static_cast<std::size_t>(node_rows_));
  smooth_row_.resize((node_row_.size() - 1) * spacing);
  inverse_.resize((columns + 2) * (rows + 2));
  edge_row_.resize(columns);
  fill_tables();
}

void DepthNoise::fill_tables() {
  Random random = Random::stream(seed_, 0);
  fill_normal(random, white_);
  const float white_scale = static_cast<float>(std::sqrt(model_.white_share));
  for (float& error : white_) error *= white_scale;

  for (float& limit : lost_above_) {
    const double cosine = model_.grazing_cosine_lost +
                          (model_.grazing_cosine_safe - model_.grazing_cosine_lost) * share(random);
    const bool lost_anyway = share(random) < model_.dropout_rate;
    limit = lost_anyway ? 0.0F : static_cast<float>(1.0 / (cosine * cosine));
  }

  // Interpolation between independent nodes loses variance in between: the weights restore it.
  for (int i = 0; i < model_.node_spacing; ++i) {
    const double position = static_cast<double>(i) / model_.node_spacing;
    const double norm = std::hypot(1.0 - position, position);
    near_weight_[static_cast<std::size_t>(i)] = static_cast<float>((1.0 - position) / norm);
    far_weight_[static_cast<std::size_t>(i)] = static_cast<float>(position / norm);
  }
}

void DepthNoise::apply(std::uint64_t frame_index, const std::vector<float>& exact,
                       std::vector<float>& measured) {
  const std::size_t columns = static_cast<std::size_t>(intrinsics_.width);
  HOPSCOTCH_CHECK(exact.size() == columns * static_cast<std::size_t>(intrinsics_.height));
  Random random = Random::stream(seed_, frame_index + 1);  // stream 0 made the tables
  fill_normal(random, nodes_);
  measured.resize(exact.size());
  invert(exact);
  for (int v = 0; v < intrinsics_.height; ++v) {
    const std::size_t start = static_cast<std::size_t>(v) * columns;
    interpolate_error(v);
    measure_row(v, random, exact.data() + start, measured.data() + start);
    hide_left_band(v, measured.data() + start);
  }
  for (int v = 0; v < intrinsics_.height; ++v) disturb_edges(v, random, exact, measured);
}

const float* DepthNoise::inverse_row(int v) const {
  const std::size_t stride = static_cast<std::size_t>(intrinsics_.width) + 2;
  return inverse_.data() + static_cast<std::size_t>(v + 1) * stride + 1;
}

void DepthNoise::invert(const std::vector<float>& exact) {
  const std::size_t columns = static_cast<std::size_t>(intrinsics_.width);
  const std::size_t rows = static_cast<std::size_t>(intrinsics_.height);
  for (std::size_t v = 0; v < rows; ++v) {
    const float* const z = exact.data() + v * columns;
    float* const inverse = inverse_.data() + (v + 1) * (columns + 2) + 1;
    for (std::size_t u = 0; u < columns; ++u) inverse[u] = z[u] > 0.0F ? 1.0F / z[u] : 0.0F;
  }
}

void DepthNoise::interpolate_error(int v) {
  const std::size_t spacing = static_cast<std::size_t>(model_.node_spacing);
  const std::size_t position = static_cast<std::size_t>(v % model_.node_spacing);
  const float* const above =
      nodes_.data() + static_cast<std::size_t>(v / model_.node_spacing) * node_row_.size();
  const float* const below = above + node_row_.size();
  const float scale = static_cast<float>(std::sqrt(1.0 - model_.white_share));
  const float above_weight = scale * near_weight_[position];
  const float below_weight = scale * far_weight_[position];
  for (std::size_t i = 0; i < node_row_.size(); ++i) {
    node_row_[i] = above_weight * above[i] + below_weight * below[i];
  }
  const float* const near_weight = near_weight_.data();
  const float* const far_weight = far_weight_.data();
  for (std::size_t cell = 0; cell + 1 < node_row_.size(); ++cell) {
    const float left = node_row_[cell];
    const float right = node_row_[cell + 1];
    float* const smooth = smooth_row_.data() + cell * spacing;
    for (std::size_t i = 0; i < spacing; ++i) {
      smooth[i] = left * near_weight[i] + right * far_weight[i];
    }
  }
}

/// Error, quantisation, range and grazing dropouts of one row. The cosine of incidence comes from
/// the gradient of 1/z, constant on a plane; of the two sides of a pixel the flatter one counts, so
/// that an edge does not look like a grazing surface.
void DepthNoise::measure_row(int v, Random& random, const float* exact, float* measured) const {
  const float* const here = inverse_row(v);
  const float* const above = inverse_row(v - 1);
  const float* const below = inverse_row(v + 1);
  const float* const white = white_.data() + window(random);
  const float* const lost_above = lost_above_.data() + window(random);
  const float* const smooth = smooth_row_.data();
  const float fx = static_cast<float>(intrinsics_.fx);
  const float fy = static_cast<float>(intrinsics_.fy);
  const float cx = static_cast<float>(intrinsics_.cx);
  const float y = static_cast<float>((v - intrinsics_.cy) / intrinsics_.fy);
  const float sigma_floor = static_cast<float>(model_.sigma_floor);
  const float sigma_growth = static_cast<float>(model_.sigma_growth);
  const float nearest = static_cast<float>(range_.nearest);
  const float farthest = static_cast<float>(range_.farthest);
  const float per_metre = static_cast<float>(1.0 / model_.quantum);
  const float quantum = static_cast<float>(model_.quantum);
  for (int u = 0; u < intrinsics_.width; ++u) {
    const float from_left = here[u] - here[u - 1];
    const float to_right = here[u + 1] - here[u];
    const float from_above = here[u] - above[u];
    const float to_below = below[u] - here[u];
    const float n_x = fx * (std::abs(from_left) < std::abs(to_right) ? from_left : to_right);
    const float n_y = fy * (std::abs(from_above) < std::abs(to_below) ? from_above : to_below);
    const float x = (static_cast<float>(u) - cx) / fx;
    const float n_z = here[u] - x * n_x - y * n_y;
    const float spread = (n_x * n_x + n_y * n_y + n_z * n_z) * (x * x + y * y + 1.0F);
    const bool lost = spread > lost_above[u] * here[u] * here[u];

    const float z = exact[u];
    const float noisy = z + (sigma_floor + sigma_growth * z * z) * (smooth[u] + white[u]);
    const bool in_range = (z > 0.0F) & (noisy >= nearest) & (noisy <= farthest);
    const float rounded = quantum * static_cast<float>(static_cast<int>(noisy * per_metre + 0.5F));
    measured[u] = in_range & !lost ? rounded : 0.0F;
  }
}

/// The right imager does not see what lies less than one disparity from the left rim.
void DepthNoise::hide_left_band(int v, float* measured) const {
  const float disparity_metres = static_cast<float>(intrinsics_.fx * model_.baseline);
  const float* const inverse = inverse_row(v);
  const int widest =
      std::min(intrinsics_.width, static_cast<int>(disparity_metres / range_.nearest) + 1);
  for (int u = 0; u < widest; ++u) {
    if (static_cast<float>(u) < disparity_metres * inverse[u]) measured[u] = 0.0F;
  }
}

/// Marks where the depth of row `v` jumps to the right or downwards: 1/z makes equal steps on a
/// plane however flat it is seen, so the smaller one of the neighbouring steps is what a plane
/// explains. 1/z of nothing is zero: the outline of what stands before nothing is an edge too.
void DepthNoise::find_edges(int v) {
  const float* const above = inverse_row(v - 1);
  const float* const here = inverse_row(v);
  const float* const below = inverse_row(v + 1);
  const float* const next_below = inverse_row(std::min(v + 2, intrinsics_.height));
  const auto jumps = [jump = static_cast<float>(model_.edge_jump)](float before, float from,
                                                                   float to, float after) {
    const float explained = std::min(std::abs(from - before), std::abs(after - to));
    return std::abs(to - from) > jump * std::max(from, to) + 2.0F * explained;
  };
  std::uint8_t* const edges = edge_row_.data();
  const int columns = intrinsics_.width;  // bytes written through `edges` might be the member
  for (int u = 0; u < columns; ++u) {
    const bool right = jumps(here[u - 1], here[u], here[u + 1], here[u + 2]);
    const bool down = jumps(above[u], here[u], below[u], next_below[u]);
    edges[u] = static_cast<std::uint8_t>((right ? kEdgeRight : 0) | (down ? kEdgeBelow : 0));
  }
}

void DepthNoise::disturb_edges(int v, Random& random, const std::vector<float>& exact,
                               std::vector<float>& measured) {
  find_edges(v);
  const float* const here = inverse_row(v);
  const float* const below = inverse_row(v + 1);
  for (int u = 0; u < intrinsics_.width; ++u) {
    const std::uint8_t edges = edge_row_[static_cast<std::size_t>(u)];
    if (edges == 0) continue;
    if ((edges & kEdgeRight) != 0 && u + 1 < intrinsics_.width) {
      const bool nearer_right = here[u + 1] > here[u];
      const Edge edge = nearer_right ? Edge{u + 1, v, -1, 0} : Edge{u, v, 1, 0};
      disturb_edge(edge, random, exact, measured);
      if (nearer_right) cast_shadow(edge, measured);
    }
    if ((edges & kEdgeBelow) != 0 && v + 1 < intrinsics_.height) {
      const bool nearer_below = below[u] > here[u];
      disturb_edge(nearer_below ? Edge{u, v + 1, 0, -1} : Edge{u, v, 0, 1}, random, exact,
                   measured);
    }
  }
}

/// Stereo matching at an edge loses pixels on both sides and, on the far side, mixes the surfaces.
void DepthNoise::disturb_edge(const Edge& edge, Random& random, const std::vector<float>& exact,
                              std::vector<float>& measured) const {
  const std::size_t near_pixel = pixel(edge.u, edge.v);
  if (share(random) < model_.edge_dropout_rate) measured[near_pixel] = 0.0F;
  const double z_near = static_cast<double>(exact[near_pixel]);
  for (int k = 1; k <= model_.edge_width; ++k) {
    const int u = edge.u + k * edge.du;
    const int v = edge.v + k * edge.dv;
    if (u < 0 || v < 0 || u >= intrinsics_.width || v >= intrinsics_.height) return;
    const std::size_t far_pixel = pixel(u, v);
    const double z_far = static_cast<double>(exact[far_pixel]);
    if (!(z_far > z_near)) return;  // nothing to mix with, or the next edge already
    const double fate = share(random);
    if (fate < model_.flying_rate) {
      const double z = z_near + share(random) * (z_far - z_near);
      // The same product as above, so that all readings are the same whole steps bit by bit.
      measured[far_pixel] =
          static_cast<float>(model_.quantum) * static_cast<float>(std::lround(z / model_.quantum));
    } else if (fate < model_.flying_rate + model_.edge_dropout_rate) {
      measured[far_pixel] = 0.0F;
    }
  }
}

/// Left of a nearer surface, the right imager sees that surface instead: all far pixels that match
/// at or behind the edge's own place in the right image are lost.
void DepthNoise::cast_shadow(const Edge& edge, std::vector<float>& measured) const {
  const float disparity_metres = static_cast<float>(intrinsics_.fx * model_.baseline);
  const float* const inverse = inverse_row(edge.v);
  const float edge_match = static_cast<float>(edge.u) - disparity_metres * inverse[edge.u];
  for (int u = edge.u - 1; u >= 0; --u) {
    if (static_cast<float>(u) - disparity_metres * inverse[u] < edge_match) return;
    measured[pixel(u, edge.v)] = 0.0F;
  }
}

}  // namespace hopscotch::sim
