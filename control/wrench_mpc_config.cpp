#include "control/wrench_mpc.hpp"

namespace hopscotch::control {

namespace {

/// A friction pyramid steeper than this is no floor that the robot may trust.
constexpr double kFrictionMax = 1.2;
constexpr double kLeverMax = 0.5;  ///< No foot is longer [m].

BodyState load_state_weight(const core::ConfigReader& section) {
  const core::ConfigReader weight = section.section("state_weight");
  const Eigen::Vector3d position = weight.vector<3>("position", core::Range::not_negative());
  const Eigen::Vector3d rpy = weight.vector<3>("rpy", core::Range::not_negative());
  const Eigen::Vector3d velocity = weight.vector<3>("velocity", core::Range::positive());
  const Eigen::Vector3d rate = weight.vector<3>("rate", core::Range::positive());
  weight.finish();
  BodyState result;
  result << position, rpy, velocity, rate;
  return result;
}

FootInput load_wrench_weight(const core::ConfigReader& section) {
  const core::ConfigReader weight = section.section("wrench_weight");
  const core::Range range{.lowest = WrenchQp::kMinInputWeight};
  const Eigen::Vector3d force = weight.vector<3>("force", range);
  const Eigen::Vector2d moment = weight.vector<2>("moment", range);
  weight.finish();
  FootInput result;
  result << force.x(), force.y(), moment, force.z();
  return result;
}

QpTolerances load_tolerances(const core::ConfigReader& section) {
  QpTolerances result;
  result.iteration_cap = section.integer("iteration_cap", 1, 100);
  result.gap = section.number("gap_tolerance", core::Range::above(0.0, 1e-2));
  result.stationarity = section.number("stationarity_tolerance", core::Range::above(0.0, 1e-2));
  return result;
}

}  // namespace

WrenchMpcConfig WrenchMpcConfig::load(const core::ConfigReader& section) {
  WrenchMpcConfig config;
  config.horizon = section.integer("horizon", 1, WrenchQp::kMaxHorizon);
  config.rule = section.choice("step_rule", {"euler", "zero_order_hold"}) == 0
                    ? StepRule::euler
                    : StepRule::zero_order_hold;
  config.state_weight = load_state_weight(section);
  config.wrench_weight = load_wrench_weight(section);
  config.friction = section.number("friction", core::Range::above(0.0, kFrictionMax));
  config.cop_toe = section.number("cop_toe_m", core::Range::above(0.0, kLeverMax));
  config.cop_heel = section.number("cop_heel_m", core::Range::above(0.0, kLeverMax));
  config.yaw_moment_arm = section.number("yaw_moment_arm_m", core::Range::above(0.0, kLeverMax));
  config.max_normal_force = section.number("max_normal_force_N", core::Range::positive());
  config.tolerances = load_tolerances(section);
  section.finish();
  return config;
}

}  // namespace hopscotch::control
