#include "perception/perception_config.hpp"

namespace hopscotch::perception {

using core::ConfigReader;
using core::Range;

DepthNoiseConfig DepthNoiseConfig::load(const ConfigReader& section) {
  DepthNoiseConfig config;
  config.base = section.number("base_m", Range::positive());
  config.quadratic = section.number("quadratic_per_m", Range::not_negative());
  config.floor = section.number("floor_m", Range::positive());
  config.tilt = section.number("tilt_rad", Range::closed(0.0, 0.1));
  section.finish();
  return config;
}

DepthFilterConfig DepthFilterConfig::load(const ConfigReader& section) {
  DepthFilterConfig config;
  config.range_min = section.number("range_min_m", Range::positive());
  config.range_max = section.number("range_max_m", Range::positive());
  if (config.range_max <= config.range_min) {
    section.reject("range_max_m", "must be larger than range_min_m");
  }
  config.jump_ratio = section.number("jump_ratio", Range::above(0.0, 1.0));
  config.jump_sigmas = section.number("jump_sigmas", Range::positive());
  config.mask_margin = section.number("mask_margin_m", Range::closed(0.0, 0.2));
  config.mask_margin_px = section.number("mask_margin_px", Range::closed(0.0, 50.0));
  section.finish();
  return config;
}

MapperConfig MapperConfig::load(const ConfigReader& section) {
  MapperConfig config;
  config.resolution = section.number("resolution_m", Range::closed(0.005, 0.05));
  config.window = section.number("window_m", Range::closed(1.0, 10.0));
  config.window_ahead = section.number("window_ahead_m", Range::closed(0.0, 3.0));
  config.reanchor_distance = section.number("reanchor_distance_m", Range::closed(0.05, 2.0));
  config.lateral_max = section.number("lateral_max_m", Range::positive());
  config.column_step = section.integer("column_step", 1, 16);
  config.near_row_step = section.integer("near_row_step", 1, 16);
  config.points_min = section.integer("points_min", 1, 100);
  config.cluster_height = section.number("cluster_height_m", Range::positive());
  config.cluster_share = section.number("cluster_share", Range::above(0.0, 1.0));
  config.cell_offset_max = section.number("cell_offset_max", Range::above(0.0, 0.5));
  config.gate_sigmas = section.number("gate_sigmas", Range::positive());
  config.confirm_frames = section.integer("confirm_frames", 1, 100);
  config.replace_frames = section.integer("replace_frames", 1, 100);
  config.sight_margin = section.number("sight_margin_m", Range::positive());
  config.speed_max = section.number("speed_max_m_s", Range::positive());
  config.angular_speed_max = section.number("angular_speed_max_rad_s", Range::positive());
  config.support_sigma = section.number("support_sigma_m", Range::positive());
  config.support_margin = section.number("support_margin_m", Range::closed(0.0, 0.1));
  section.finish();
  return config;
}

OneStepConfig OneStepConfig::load(const ConfigReader& section) {
  OneStepConfig config;
  config.track_margin = section.number("track_margin_m", Range::closed(0.0, 0.1));
  config.support_share = section.number("support_share", Range::above(0.0, 1.0));
  config.level_tolerance = section.number("level_tolerance_m", Range::positive());
  config.step_min = section.number("step_min_m", Range::positive());
  config.gap_min = section.number("gap_min_m", Range::positive());
  config.pit_depth = section.number("pit_depth_m", Range::positive());
  config.foothold_length = section.number("foothold_length_m", Range::positive());
  config.blind_length = section.number("blind_length_m", Range::not_negative());
  config.edge_sigma = section.number("edge_sigma_m", Range::positive());
  section.finish();
  return config;
}

OccupancyConfig OccupancyConfig::load(const ConfigReader& section) {
  OccupancyConfig config;
  config.voxel = section.number("voxel_m", Range::closed(0.01, 0.2));
  config.pixel_step = section.integer("pixel_step", 1, 64);
  config.period = section.number("period_s", Range::closed(0.0, 10.0));
  config.reach = section.number("reach_m", Range::positive());
  config.half_height = section.number("half_height_m", Range::positive());
  config.hit = section.number("hit", Range::closed(0.5, 0.99));
  config.miss = section.number("miss", Range::closed(0.01, 0.5));
  config.occupied = section.number("occupied", Range::closed(0.5, 0.99));
  config.clamp_low = section.number("clamp_low", Range::closed(0.01, 0.5));
  config.clamp_high = section.number("clamp_high", Range::closed(config.occupied, 0.99));
  config.nodes_max = section.integer("nodes_max", 1000, 10'000'000);
  section.finish();
  return config;
}

PerceptionConfig PerceptionConfig::load(const ConfigReader& section) {
  PerceptionConfig config;
  config.noise = DepthNoiseConfig::load(section.section("noise"));
  config.filter = DepthFilterConfig::load(section.section("depth_filter"));
  config.mapper = MapperConfig::load(section.section("mapper"));
  config.one_step = OneStepConfig::load(section.section("one_step"));
  config.occupancy = OccupancyConfig::load(section.section("occupancy"));
  config.planes = PlaneConfig::load(section.section("planes"));
  config.calibration = CalibrationConfig::load(section.section("calibration"));
  section.finish();
  return config;
}

}  // namespace hopscotch::perception
