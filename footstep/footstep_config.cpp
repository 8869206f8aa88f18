#include "footstep/footstep_config.hpp"

#include <algorithm>
#include <string_view>

namespace hopscotch::footstep {

using core::ConfigReader;
using core::Range;

namespace {

std::vector<double> column(const ConfigReader& section, std::string_view key, std::size_t size) {
  std::vector<double> values = section.number_list(key);
  if (values.size() != size) section.reject(key, "must have as many entries as height_m");
  return values;
}

}  // namespace

FootholdConfig FootholdConfig::load(const ConfigReader& section) {
  FootholdConfig config;
  config.margin_min = section.number("margin_min_m", Range::closed(0.0, 0.2));
  config.lateral_margin = section.number("lateral_margin_m", Range::closed(0.0, 0.08));
  config.flat_tolerance = section.number("flat_tolerance_m", Range::positive());
  config.flat_share = section.number("flat_share", Range::above(0.0, 1.0));
  config.edge_tolerance = section.number("edge_tolerance_m", Range::positive());
  config.step_tolerance = section.number("step_tolerance_m", Range::positive());
  config.slope_max = section.number("slope_max_rad", Range::closed(0.0, 1.0));
  config.cross_slope_max = section.number("cross_slope_max_rad", Range::closed(0.0, 1.0));
  config.knee_room = section.number("knee_room_m", Range::not_negative());
  config.knee_rise = section.number("knee_rise_m", Range::not_negative());
  config.edge_sigma = section.number("edge_sigma_m", Range::positive());
  config.landing_sigma = section.number("landing_sigma_m", Range::positive());
  config.height_sigma_max = section.number("height_sigma_max_m", Range::positive());
  config.probability_min = section.number("probability_min", Range::closed(0.0, 1.0));
  section.finish();
  return config;
}

ReachConfig ReachConfig::load(const ConfigReader& section) {
  ReachConfig config;
  config.height = section.number_list("height_m");
  if (config.height.size() < 2 || !std::is_sorted(config.height.begin(), config.height.end())) {
    section.reject("height_m", "must be two or more ascending heights");
  }
  const std::size_t size = config.height.size();
  config.distance_min = column(section, "distance_min_m", size);
  config.distance_max = column(section, "distance_max_m", size);
  config.takeoff_edge_max = column(section, "takeoff_edge_max_m", size);
  config.past_edge_min = column(section, "past_edge_min_m", size);
  for (std::size_t i = 0; i < size; ++i) {
    if (!(0.0 < config.distance_min[i] && config.distance_min[i] <= config.distance_max[i])) {
      section.reject("distance_min_m", "must be positive and not above distance_max_m");
    }
  }
  config.takeoff_edge_reserve = section.number("takeoff_edge_reserve_m", Range::not_negative());
  config.drop_min = section.number("drop_min_m", Range::not_negative());
  config.hurdle_max = section.number("hurdle_max_m", Range::not_negative());
  config.head_room = section.number("head_room_m", Range::positive());
  config.body_half_width = section.number("body_half_width_m", Range::positive());
  config.lateral_max = section.number("lateral_max_m", Range::not_negative());
  config.yaw_max = section.number("yaw_max_rad", Range::not_negative());
  section.finish();
  return config;
}

ProfileConfig ProfileConfig::load(const ConfigReader& section) {
  ProfileConfig config;
  config.unknown_margin = section.number("unknown_margin_m", Range::not_negative());
  config.unknown_length_max = section.number("unknown_length_max_m", Range::not_negative());
  section.finish();
  return config;
}

PreferenceConfig PreferenceConfig::load(const ConfigReader& section) {
  PreferenceConfig config;
  config.nominal_distance = section.number("nominal_distance_m", Range::positive());
  config.spacing = section.number("spacing_m", Range::closed(0.005, 0.1));
  config.margin_wanted = section.number("margin_wanted_m", Range::not_negative());
  config.margin_weight = section.number("margin_weight", Range::not_negative());
  config.step_cost = section.number("step_cost_m", Range::not_negative());
  config.look_ahead = section.integer("look_ahead", 1, 5);
  config.discount = section.number("discount", Range::closed(0.0, 1.0));
  config.unseen_cost = section.number("unseen_cost_m", Range::not_negative());
  config.hidden_cost = section.number("hidden_cost_m", Range::not_negative());
  config.dead_end_cost = section.number("dead_end_cost_m", Range::not_negative());
  config.dead_end_advance = section.number("dead_end_advance_m", Range::not_negative());
  config.goal_margin = section.number("goal_margin_m", Range::not_negative());
  section.finish();
  return config;
}

FootstepConfig FootstepConfig::load(const ConfigReader& section) {
  FootstepConfig config;
  config.foothold = FootholdConfig::load(section.section("foothold"));
  config.reach = ReachConfig::load(section.section("reach"));
  config.profile = ProfileConfig::load(section.section("profile"));
  config.doubt = DoubtConfig::load(section.section("doubt"));
  config.preference = PreferenceConfig::load(section.section("preference"));
  section.finish();
  return config;
}

}  // namespace hopscotch::footstep
