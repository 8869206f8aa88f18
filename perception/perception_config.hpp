#pragma once

#include "core/config_reader.hpp"
#include "perception/camera_calibration.hpp"
#include "perception/plane_segmentation.hpp"

namespace hopscotch::perception {

/// How far a depth reading may be off; section `perception.noise`.
struct DepthNoiseConfig {
  double base = 0.0;       ///< Standard deviation of depth at no distance [m].
  double quadratic = 0.0;  ///< Its growth with the square of depth [1/m].
  double floor = 0.0;      ///< Error of a cell's height that all frames share [m].
  double tilt = 0.0;       ///< Error of the camera's pitch, that all frames share [rad].

  static DepthNoiseConfig load(const core::ConfigReader& section);
};

/// Which pixels count; section `perception.depth_filter`.
struct DepthFilterConfig {
  double range_min = 0.0;       ///< Along the optical axis [m].
  double range_max = 0.0;       ///< Along the optical axis [m].
  double jump_ratio = 0.0;      ///< Relative depth change within 3x3 pixels that is an edge.
  double jump_sigmas = 0.0;     ///< The same counted in standard deviations; the larger one holds.
  double mask_margin = 0.0;     ///< The body is taken to be thicker by this [m].
  double mask_margin_px = 0.0;  ///< And by this in the image [pixel].

  static DepthFilterConfig load(const core::ConfigReader& section);
};

/// How points become a map; section `perception.mapper`.
struct MapperConfig {
  double resolution = 0.0;         ///< Of the grid [m].
  double window = 0.0;             ///< Side of the square map [m].
  double window_ahead = 0.0;       ///< Its centre lies so far ahead of the robot [m].
  double reanchor_distance = 0.0;  ///< The map is moved when its centre is off by more [m].
  double lateral_max = 0.0;        ///< Points farther beside the robot are not used [m].
  int column_step = 1;             ///< Every so many pixel columns are used.
  int near_row_step = 1;           ///< Every so many pixel rows of the lower image half are used.
  int points_min = 1;              ///< Fewer points in a cell of one frame say nothing.
  double cluster_height = 0.0;     ///< Points of one surface lie within this [m].
  double cluster_share = 0.0;      ///< A surface must hold this share of a covered cell's points.
  double cell_offset_max = 0.0;    ///< The centre of a surface's points may be off the cell's
                                   ///< centre by this; a quarter when it covers half [cells].
  double gate_sigmas = 0.0;        ///< A measurement farther off contradicts the map.
  int confirm_frames = 1;          ///< Agreeing frames that make a cell observed.
  int replace_frames = 1;          ///< Agreeing frames that overrule an observed cell.
  double sight_margin = 0.0;       ///< Rays must pass so far below a cell to contradict it [m].
  double speed_max = 0.0;          ///< Of the trunk; no fusion above [m/s].
  double angular_speed_max = 0.0;  ///< Of the trunk; no fusion above [rad/s].
  double support_sigma = 0.0;      ///< Height error of support known by contact [m].
  double support_margin = 0.0;     ///< Ground beside a loaded sole taken as level with it [m].

  static MapperConfig load(const core::ConfigReader& section);
};

/// How the map becomes the one-step product; section `perception.one_step`.
struct OneStepConfig {
  double track_margin = 0.0;   ///< A foot's track is wider than the foot by this, each side [m].
  double support_share = 0.0;  ///< Observed share of a slice across the tracks to count as support.
  double level_tolerance = 0.0;  ///< Heights that differ less are one level [m].
  double step_min = 0.0;         ///< Smaller steps are roughness [m].
  double gap_min = 0.0;          ///< Shorter stretches without support are no gap [m].
  double pit_depth = 0.0;        ///< A floor so far below its surroundings is no support [m].
  double foothold_length = 0.0;  ///< Lower ground shorter than this is part of a gap [m].
  double blind_length = 0.0;     ///< Longest unseen strip ahead of the toes taken as level [m].
  double edge_sigma = 0.0;       ///< Error of an edge's position, the grid apart [m].

  static OneStepConfig load(const core::ConfigReader& section);
};

/// The volumetric memory; section `perception.occupancy`.
struct OccupancyConfig {
  double voxel = 0.0;        ///< Edge of a voxel [m].
  int pixel_step = 1;        ///< Of images 640 wide every so many pixels are used.
  double period = 0.0;       ///< Between frames that are taken in [s].
  double reach = 0.0;        ///< Remembered to so far from the camera along x and y of W [m].
  double half_height = 0.0;  ///< And above and below it [m].
  double hit = 0.0;          ///< Probability of an occupied voxel where a ray ends.
  double miss = 0.0;         ///< The same where a ray passes.
  double occupied = 0.0;     ///< From this probability on a voxel counts as occupied.
  double clamp_low = 0.0;    ///< Probabilities stay above.
  double clamp_high = 0.0;   ///< And below, so that a few rays clear what has moved.
  int nodes_max = 0;         ///< Of the tree, before what is far away is dropped.

  static OccupancyConfig load(const core::ConfigReader& section);
};

/// Section `perception` of the configuration.
struct PerceptionConfig {
  DepthNoiseConfig noise;
  DepthFilterConfig filter;
  MapperConfig mapper;
  OneStepConfig one_step;
  OccupancyConfig occupancy;
  PlaneConfig planes;
  CalibrationConfig calibration;

  /// @throws core::ConfigError naming the key, its value and the violated rule.
  static PerceptionConfig load(const core::ConfigReader& section);
};

}  // namespace hopscotch::perception
