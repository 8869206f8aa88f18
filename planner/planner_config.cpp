#include "planner/planner_config.hpp"

#include <algorithm>
#include <cmath>

namespace hopscotch::planner {

namespace {

using core::ConfigReader;
using core::Range;

StepCounts load_steps(const ConfigReader& section) {
  StepCounts steps;
  steps.takeoff = section.integer("takeoff", 5, 80);
  steps.flight = section.integer("flight", 4, 40);
  steps.landing = section.integer("landing", 4, 60);
  section.finish();
  return steps;
}

Reserves load_reserves(const ConfigReader& section) {
  Reserves reserves;
  reserves.torque = section.number("torque", Range::above(0.0, 1.0));
  reserves.speed = section.number("speed", Range::above(0.0, 1.0));
  reserves.power = section.number("power", Range::above(0.0, 1.0));
  reserves.friction = section.number("friction", Range::above(0.0, 1.0));
  section.finish();
  return reserves;
}

CostWeights load_cost(const ConfigReader& section) {
  CostWeights weights;
  weights.posture = section.number("posture", Range::not_negative());
  weights.rate = section.number("rate", Range::not_negative());
  weights.torque = section.number("torque", Range::not_negative());
  weights.acceleration = section.number("acceleration", Range::not_negative());
  weights.trunk_pitch = section.number("trunk_pitch", Range::not_negative());
  section.finish();
  return weights;
}

void load_limits(const ConfigReader& section, PlannerConfig& config) {
  config.normal_force_min = section.number("normal_force_min_N", Range::not_negative());
  config.normal_force_max = section.number("normal_force_max_N", Range::positive());
  config.takeoff_cop_margin = section.number("takeoff_cop_margin_m", Range::closed(0.0, 0.06));
  config.landing_cop_margin = section.number("landing_cop_margin_m", Range::closed(0.0, 0.06));
  config.joint_margin = section.number("joint_margin_rad", Range::closed(0.0, 0.3));
  config.shank_pitch_max = section.number("shank_pitch_max_rad", Range::above(0.0, 1.5));
  config.trunk_pitch_min = section.number("trunk_pitch_min_rad", Range::closed(-1.5, 0.0));
  config.trunk_pitch_max = section.number("trunk_pitch_max_rad", Range::closed(0.0, 1.5));
  config.foot_pitch_max = section.number("foot_pitch_max_rad", Range::above(0.0, 1.5));
  config.touchdown_speed_down =
      section.number("touchdown_speed_down_max_mps", Range::closed(0.05, 3.0));
  config.touchdown_speed_down_min = section.number("touchdown_speed_down_min_mps",
                                                   Range::closed(0.0, config.touchdown_speed_down));
  config.touchdown_speed_along =
      section.number("touchdown_speed_along_max_mps", Range::closed(0.0, 3.0));
  config.touchdown_foot_rate =
      section.number("touchdown_foot_rate_max_rad_s", Range::closed(0.0, 20.0));
  section.finish();
}

void load_clearance(const ConfigReader& section, PlannerConfig& config) {
  config.clearance = section.number("foot_m", Range::closed(0.0, 0.2));
  config.knee_clearance = section.number("knee_m", Range::closed(0.0, 0.2));
  section.finish();
}

}  // namespace

double PlannerConfig::landing_step_longest(double distance, double height) const {
  constexpr double kEasy = 0.40;  // distance and rise together [m]
  constexpr double kHard = 0.55;
  const double share = (distance + std::max(height, 0.0) - kEasy) / (kHard - kEasy);
  return std::lerp(landing_step_max, landing_step_hard, std::clamp(share, 0.0, 1.0));
}

double PlannerConfig::takeoff_step(int k) const {
  const double share = static_cast<double>(k) / (steps.takeoff - 1);
  return takeoff_first_step + share * (takeoff_last_step - takeoff_first_step);
}

double PlannerConfig::landing_share(int k) const {
  const double progress = static_cast<double>(k) / (steps.landing - 1);
  return landing_first_share + 2.0 * progress * (1.0 - landing_first_share);
}

double PlannerConfig::takeoff_time() const {
  return 0.5 * steps.takeoff * (takeoff_first_step + takeoff_last_step);
}

PlannerConfig PlannerConfig::load(const ConfigReader& section) {
  PlannerConfig config;
  config.steps = load_steps(section.section("steps"));
  config.takeoff_first_step =
      1e-3 * section.number("takeoff_first_step_ms", Range::closed(5.0, 60.0));
  config.takeoff_last_step =
      1e-3 * section.number("takeoff_last_step_ms", Range::closed(5.0, 60.0));
  config.flight_step_min = 1e-3 * section.number("flight_step_min_ms", Range::above(0.0, 50.0));
  config.flight_step_max = 1e-3 * section.number("flight_step_max_ms", Range::above(0.0, 100.0));
  config.landing_step_min = 1e-3 * section.number("landing_step_min_ms", Range::above(0.0, 50.0));
  config.landing_step_max = 1e-3 * section.number("landing_step_max_ms", Range::above(0.0, 100.0));
  config.landing_step_hard =
      1e-3 *
      section.number("landing_step_hard_ms", Range::closed(1e3 * config.landing_step_max, 100.0));
  if (config.flight_step_min > config.flight_step_max) {
    section.reject("flight_step_min_ms", "must not exceed flight_step_max_ms");
  }
  if (config.landing_step_min > config.landing_step_max) {
    section.reject("landing_step_min_ms", "must not exceed landing_step_max_ms");
  }
  config.landing_first_share = section.number("landing_first_share", Range::closed(0.2, 1.0));
  config.friction = section.number("friction", Range::above(0.0, 1.2));
  config.reserves = load_reserves(section.section("reserves"));
  load_limits(section.section("limits"), config);
  load_clearance(section.section("clearance"), config);
  const ConfigReader cost = section.section("cost");
  config.takeoff_cost = load_cost(cost.section("takeoff"));
  config.flight_cost = load_cost(cost.section("flight"));
  config.landing_cost = load_cost(cost.section("landing"));
  config.rate_jump_cost = cost.number("rate_jump", Range::not_negative());
  config.smoothness_cost = cost.number("smoothness", Range::not_negative());
  cost.finish();
  const ConfigReader target = section.section("target");
  config.lateral_max = target.number("lateral_max_m", Range::not_negative());
  config.yaw_max = target.number("yaw_max_rad", Range::not_negative());
  target.finish();
  const ConfigReader solver = section.section("solver");
  config.iterations_max = solver.integer("iterations_max", 1, 1000);
  config.tolerance = solver.number("tolerance", Range::above(0.0, 0.1));
  solver.finish();
  section.finish();
  return config;
}

}  // namespace hopscotch::planner
