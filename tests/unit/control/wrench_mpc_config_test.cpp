#include <gtest/gtest.h>

#include <string>

#include "control/wrench_mpc.hpp"
#include "tests/unit/control/mpc_samples.hpp"

namespace hopscotch::control {
namespace {

const std::string kGood =
    "horizon: 10\n"
    "step_rule: euler\n"
    "state_weight: {position: [1, 2, 3], rpy: [4, 5, 6], velocity: [7, 8, 9], rate: [10, 11, 12]}\n"
    "wrench_weight: {force: [1.0e-6, 2.0e-6, 3.0e-6], moment: [4.0e-6, 5.0e-6]}\n"
    "friction: 0.5\n"
    "cop_toe_m: 0.075\n"
    "cop_heel_m: 0.055\n"
    "yaw_moment_arm_m: 0.03\n"
    "max_normal_force_N: 500\n"
    "iteration_cap: 25\n"
    "gap_tolerance: 1.0e-8\n"
    "stationarity_tolerance: 1.0e-6\n";

WrenchMpcConfig load(const std::string& text) {
  return WrenchMpcConfig::load(core::ConfigReader::from_text(text, "test.yaml"));
}

std::string replaced(const std::string& from, const std::string& to) {
  std::string text = kGood;
  text.replace(text.find(from), from.size(), to);
  return text;
}

TEST(WrenchMpcConfig, ReadsEveryNumberToItsPlace) {
  const WrenchMpcConfig config = load(kGood);
  EXPECT_EQ(config.horizon, 10);
  EXPECT_EQ(config.rule, StepRule::euler);
  for (int i = 0; i < 12; ++i) EXPECT_EQ(config.state_weight(i), 1.0 + i);
  EXPECT_EQ(config.wrench_weight(kForceX), 1e-6);
  EXPECT_EQ(config.wrench_weight(kForceY), 2e-6);
  EXPECT_EQ(config.wrench_weight(kForceZ), 3e-6);
  EXPECT_EQ(config.wrench_weight(kMomentY), 4e-6);
  EXPECT_EQ(config.wrench_weight(kMomentZ), 5e-6);
  EXPECT_EQ(config.friction, 0.5);
  EXPECT_EQ(config.cop_toe, 0.075);
  EXPECT_EQ(config.cop_heel, 0.055);
  EXPECT_EQ(config.yaw_moment_arm, 0.03);
  EXPECT_EQ(config.max_normal_force, 500.0);
  EXPECT_EQ(config.tolerances.iteration_cap, 25);
  EXPECT_EQ(config.tolerances.gap, 1e-8);
  EXPECT_EQ(config.tolerances.stationarity, 1e-6);
}

TEST(WrenchMpcConfig, ShippedFileIsAccepted) {
  const WrenchMpcConfig config = WrenchMpcConfig::load(testing::mpc_section());
  EXPECT_EQ(config.rule, StepRule::zero_order_hold);
  EXPECT_EQ(config.wrench_weight, FootInput::Constant(1e-6));
}

TEST(WrenchMpcConfig, RefusesWhatTheSolverCannotBear) {
  EXPECT_THROW(load(replaced("horizon: 10", "horizon: 21")), core::ConfigError);
  EXPECT_THROW(load(replaced("friction: 0.5", "friction: 1.7")), core::ConfigError);
  EXPECT_THROW(load(replaced("1.0e-6, 2.0e-6", "1.0e-9, 2.0e-6")), core::ConfigError);
  EXPECT_THROW(load(replaced("[7, 8, 9]", "[7, 0, 9]")), core::ConfigError);
  EXPECT_THROW(load(replaced("step_rule: euler", "step_rule: midpoint")), core::ConfigError);
  EXPECT_THROW(load(replaced("max_normal_force_N: 500", "max_normal_force_N: 0")),
               core::ConfigError);
  EXPECT_THROW(load(kGood + "spare: 1\n"), core::ConfigError);
}

}  // namespace
}  // namespace hopscotch::control
