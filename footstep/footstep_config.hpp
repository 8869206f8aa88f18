#pragma once

#include <vector>

#include "core/config_reader.hpp"
#include "footstep/height_doubt.hpp"

namespace hopscotch::footstep {

/// What a place must offer to be stood on; section `footstep.foothold`.
struct FootholdConfig {
  double margin_min = 0.0;        ///< Toe and heel to the next edge, at least [m].
  double lateral_margin = 0.0;    ///< Support wanted beside each foot [m].
  double flat_tolerance = 0.0;    ///< Height about the fitted plane under the feet [m].
  double flat_share = 0.0;        ///< Share of the cells under the feet that must keep to it.
  double edge_tolerance = 0.0;    ///< Cells farther from the plane end the tread [m].
  double step_tolerance = 0.0;    ///< Change of mean height below a foot within 3 cm [m].
  double slope_max = 0.0;         ///< Along the jump [rad].
  double cross_slope_max = 0.0;   ///< Across the jump [rad].
  double knee_room = 0.0;         ///< Free space behind the sole centre, where knees would hit [m].
  double knee_rise = 0.0;         ///< Lower ground than this is below the knees [m].
  double edge_sigma = 0.0;        ///< Error of an edge's position [m].
  double landing_sigma = 0.0;     ///< Scatter of the landing place along the jump [m].
  double height_sigma_max = 0.0;  ///< Height must be known this well [m].
  double probability_min = 0.0;   ///< Of landing with toe and heel on the tread.

  static FootholdConfig load(const core::ConfigReader& section);
};

/// Where a jump can lead; section `footstep.reach`. Lists run over `height`, ascending.
struct ReachConfig {
  std::vector<double> height;            ///< Of the landing above the takeoff [m].
  std::vector<double> distance_min;      ///< [m]
  std::vector<double> distance_max;      ///< [m]
  std::vector<double> takeoff_edge_max;  ///< The takeoff tread must end this near ahead of S [m].
  /// After a drop the soles' mid-point is at least so far beyond the takeoff tread's end [m].
  std::vector<double> past_edge_min;
  double takeoff_edge_reserve = 0.0;  ///< Kept for landings that fall short, thinking ahead [m].
  double drop_min = 0.0;              ///< Smaller drops ask nothing of the takeoff edge [m].
  double hurdle_max = 0.0;       ///< What may stick out above takeoff and landing on the way [m].
  double head_room = 0.0;        ///< Nothing may hang lower above takeoff and landing ... [m]
  double body_half_width = 0.0;  ///< ... than so, within this of the jump line [m].
  double lateral_max = 0.0;      ///< Sideways, for the operator's targets [m].
  double yaw_max = 0.0;          ///< Turn, for the operator's targets [rad].

  static ReachConfig load(const core::ConfigReader& section);
};

/// How much unknown ground may be flown over; section `footstep.profile`.
struct ProfileConfig {
  double unknown_margin = 0.0;      ///< Unknown ground is taken this much above its rims [m].
  double unknown_length_max = 0.0;  ///< Longer unknown stretches are not flown over [m].

  static ProfileConfig load(const core::ConfigReader& section);
};

/// What makes one place better than another; section `footstep.preference`. All costs in metres of
/// deviation from the nominal distance.
struct PreferenceConfig {
  double nominal_distance = 0.0;  ///< Wanted where nothing else counts [m].
  double spacing = 0.0;           ///< Of the candidates along the jump line [m].
  double margin_wanted = 0.0;     ///< More distance to the edges than this is worth nothing [m].
  double margin_weight = 0.0;     ///< Per metre short of it.
  double step_cost = 0.0;         ///< Of one more jump [m].
  int look_ahead = 1;             ///< Jumps thought ahead, the next one included.
  double discount = 0.0;          ///< Weight of each jump compared to the one before it.
  double unseen_cost = 0.0;       ///< Of going on where nothing has been seen yet [m].
  double hidden_cost = 0.0;       ///< Of going on where a tread may be hidden [m].
  double dead_end_cost = 0.0;     ///< Of a place from which no next one is known [m].
  double dead_end_advance = 0.0;  ///< Shorter jumps to where no way on is seen are refused [m].
  double goal_margin = 0.0;       ///< Heels should be so far beyond the goal [m].

  static PreferenceConfig load(const core::ConfigReader& section);
};

/// Section `footstep` of the configuration.
struct FootstepConfig {
  FootholdConfig foothold;
  ReachConfig reach;
  ProfileConfig profile;
  DoubtConfig doubt;
  PreferenceConfig preference;

  /// @throws core::ConfigError naming the key, its value and the violated rule.
  static FootstepConfig load(const core::ConfigReader& section);
};

}  // namespace hopscotch::footstep
