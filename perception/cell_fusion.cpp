#include "perception/cell_fusion.hpp"

#include <algorithm>
#include <cmath>

namespace hopscotch::perception {

using core::CellState;

namespace {

/// Share of the normal distribution above this many sigmas is 2 %.
constexpr float kUpperSigmas = 2.0F;
/// Votes for and against are kept up to here, so that new evidence counts within a few frames.
constexpr int kVotesMax = 4;

void vote(int change, CellMemory& memory) {
  memory.cover_votes =
      static_cast<std::int8_t>(std::clamp(memory.cover_votes + change, -kVotesMax, kVotesMax));
}

/// Forgets rivals and rays, not the votes.
void settle(CellMemory& memory) {
  memory.rival_frames = 0;
  memory.through_frames = 0;
}

void set_height(float height, float variance, core::TerrainCell& cell) {
  cell.height = height;
  cell.variance = variance;
  cell.upper = height + kUpperSigmas * std::sqrt(variance);
  cell.state = CellState::observed;
}

struct Blend {
  float gain = 0.0F;          ///< Weight of the new measurement.
  float own_variance = 0.0F;  ///< Left of what frames do not share [m^2].
};

/// Frames average out what is their own error; what they share stays.
Blend blend_of(const core::TerrainCell& cell, const HeightMeasurement& measurement) {
  constexpr float kGainMin = 1.0F / 32.0F;  // the map keeps following the ground
  const float own = measurement.variance - measurement.shared_variance;
  const float known =
      std::max(cell.variance - measurement.shared_variance, kGainMin * own / (1.0F - kGainMin));
  const float gain = known + own > 0.0F ? known / (known + own) : 0.5F;
  return {.gain = gain, .own_variance = (1.0F - gain) * known};
}

/// Counts frames that agree on a height which is not the cell's.
void follow_rival(const MapperConfig& config, const HeightMeasurement& measurement,
                  CellMemory& memory) {
  const float deviation = measurement.height - memory.rival;
  const float gate =
      static_cast<float>(config.gate_sigmas * config.gate_sigmas) * 2.0F * measurement.variance;
  if (memory.rival_frames > 0 && deviation * deviation <= gate) {
    ++memory.rival_frames;
    memory.rival += deviation / static_cast<float>(memory.rival_frames);
  } else {
    memory.rival = measurement.height;
    memory.rival_frames = 1;
  }
}

}  // namespace

void fuse_height(const MapperConfig& config, const HeightMeasurement& measurement,
                 core::TerrainCell& cell, CellMemory& memory) {
  vote(1, memory);
  const bool observed = cell.state == CellState::observed;
  if (observed) {
    const float innovation = measurement.height - cell.height;
    const float total = cell.variance + measurement.variance;
    const float gate = static_cast<float>(config.gate_sigmas * config.gate_sigmas) * total;
    if (innovation * innovation <= gate) {
      const Blend blend = blend_of(cell, measurement);
      set_height(cell.height + blend.gain * innovation,
                 blend.own_variance + measurement.shared_variance, cell);
      settle(memory);
      return;
    }
  }
  follow_rival(config, measurement, memory);
  if (memory.rival_frames < (observed ? config.replace_frames : config.confirm_frames)) return;
  if (memory.cover_votes <= 0) return;
  set_height(memory.rival, measurement.variance, cell);
  settle(memory);
}

void fuse_sight(const MapperConfig& config, float ray_height, int frame, core::TerrainCell& cell,
                CellMemory& memory) {
  if (cell.state != CellState::observed) {
    if (cell.state == CellState::never_seen || ray_height < cell.upper) cell.upper = ray_height;
    cell.state = CellState::occluded;
    return;
  }
  const float margin =
      static_cast<float>(config.sight_margin + config.gate_sigmas * std::sqrt(cell.variance));
  if (ray_height > cell.height - margin || memory.last_through_frame == frame) return;
  memory.last_through_frame = frame;
  if (++memory.through_frames < config.replace_frames) return;
  cell = {.upper = ray_height, .state = CellState::occluded};
  settle(memory);
}

void fuse_edge(const MapperConfig& config, float height, int frame, core::TerrainCell& cell,
               CellMemory& memory) {
  vote(-1, memory);
  if (cell.state == CellState::observed && memory.cover_votes >= 0) {
    // Rays that end on this surface passed below whatever was taken to be higher here.
    fuse_sight(config, height, frame, cell, memory);
    return;
  }
  if (cell.state == CellState::observed) {
    cell = {.upper = height, .state = CellState::occluded};
    settle(memory);
  }
  if (cell.state == CellState::never_seen || cell.upper < height) cell.upper = height;
  cell.state = CellState::occluded;
}

void set_support(float height, float sigma, core::TerrainCell& cell, CellMemory& memory) {
  set_height(height, sigma * sigma, cell);
  memory = CellMemory{};
  memory.cover_votes = kVotesMax;
}

}  // namespace hopscotch::perception
