#pragma once

#include <gtest/gtest.h>

#include "planner/landing_phase.hpp"
#include "planner/warm_start.hpp"
#include "tests/unit/planner/planner_fixture.hpp"

namespace hopscotch::planner::testing_support {

/// A jump onto a step of 10 cm, with the kinematic guess.
class PhaseTest : public testing::Test {
 protected:
  /// Derivatives of every block near the guess, but off it.
  void expect_exact_derivatives() const {
    for (std::size_t b = 0; b < blocks_.size(); ++b) {
      const ConstraintBlock& block = *blocks_[b];
      const std::vector<double> noise =
          random_point(block.variables().size(), static_cast<unsigned>(b));
      std::vector<double> local;
      for (std::size_t i = 0; i < noise.size(); ++i) {
        const int at = block.variables()[i];
        const double value = at == kNoVariable ? 0.0 : guess_(at);
        const bool is_step = at == layout_.flight_step() || at == layout_.landing_step();
        local.push_back(value + (is_step ? 1e-3 : 0.05) * noise[i]);
      }
      const DerivativeError error = derivative_error(block, local);
      EXPECT_LT(error.slopes, kDerivativeTolerance) << "block " << b;
      EXPECT_LT(error.curvature, kDerivativeTolerance) << "block " << b;
    }
  }

  PlanarModel model_ = shipped_model();
  PlanarTask task_ = task(model_, 0.40, 0.10);
  DecisionLayout layout_{model_.config.steps};
  Eigen::VectorXd guess_ = kinematic_guess(model_, task_, layout_);
  BlockList blocks_;
};

}  // namespace hopscotch::planner::testing_support
