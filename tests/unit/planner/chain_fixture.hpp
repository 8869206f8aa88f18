#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "planner/row_places.hpp"
#include "planner/warm_start.hpp"
#include "tests/unit/planner/planner_fixture.hpp"

namespace hopscotch::planner::testing_support {

/// A jump, or what is left of its landing.
struct ChainCase {
  double distance;  ///< [m]
  double height;    ///< [m]
  int landed_steps = 0;
  bool is_corrected = false;  ///< By noise, between the knots.

  [[nodiscard]] PlannerConfig config() const {
    PlannerConfig config = shipped_config();
    if (landed_steps > 0) config.steps = {0, 0, landed_steps};
    return config;
  }
};

/// Jumps, each near its guess but off it, as blocks and as a chain.
class ChainTest : public testing::TestWithParam<ChainCase> {
 protected:
  void SetUp() override {
    if (!GetParam().is_corrected) return;
    ChainCorrection correction(problem_.layout());
    unsigned seed = 100;
    for (StepCorrection& step : correction.steps) {
      const std::vector<double> numbers = random_point(2 * model::kPlanarLinks, seed++);
      for (std::size_t j = 0; j < model::kPlanarLinks; ++j) {
        step.turn[j] = 0.01 * numbers[j];
        step.acceleration[j] = numbers[model::kPlanarLinks + j];
      }
    }
    problem_.correct(correction);
    program_ = jump_program(model_, task_, layout_, correction.steps);
  }

  /// From the start to the final posture at rest, knot after knot.
  [[nodiscard]] Eigen::VectorXd landing_guess() const {
    Eigen::VectorXd x = Eigen::VectorXd::Zero(layout_.size());
    const auto start = coordinates_from_links(task_.start.pitch);
    const auto end = coordinates_from_links(task_.final_posture);
    const int steps = layout_.steps().landing;
    for (int k = 0; k <= steps; ++k) {
      for (std::size_t d = 0; d < kStanceDof; ++d) {
        x(layout_.landing(k) + static_cast<int>(d)) =
            std::lerp(start[d], end[d], static_cast<double>(k) / steps);
      }
    }
    x(layout_.landing_step()) = 0.02;
    return x;
  }
  [[nodiscard]] Eigen::VectorXd noisy_point(unsigned seed) const {
    Eigen::VectorXd x =
        layout_.steps().landed() ? landing_guess() : kinematic_guess(model_, task_, layout_);
    const std::vector<double> noise = random_point(static_cast<std::size_t>(x.size()) + 1, seed);
    const Eigen::VectorXd sizes = decision_sizes(layout_);
    for (Eigen::Index i = 0; i < x.size(); ++i) {
      x(i) += 0.05 * sizes(i) * noise[static_cast<std::size_t>(i)];
      if (problem_.is_fixed(static_cast<int>(i))) x(i) = problem_.bounds().lower(i);
    }
    x.conservativeResize(x.size() + 1);
    x(x.size() - 1) = 0.0;
    return x;
  }
  [[nodiscard]] static Eigen::VectorXd noise(int size, unsigned seed) {
    const std::vector<double> numbers = random_point(static_cast<std::size_t>(size), seed);
    return Eigen::Map<const Eigen::VectorXd>(numbers.data(), size);
  }

  /// Numbers for slots; zero where the slot has no bound, as multipliers and weights are.
  [[nodiscard]] Eigen::VectorXd slot_noise(unsigned seed) const {
    Eigen::VectorXd out = noise(problem_.layout().slots(), seed);
    for (int i = 0; i < problem_.layout().slots(); ++i) {
      if (problem_.lower()(i) == -kUnbounded && problem_.upper()(i) == kUnbounded) out(i) = 0.0;
    }
    return out;
  }

  PlanarModel model_{hector(), GetParam().config()};
  DecisionLayout layout_{model_.config.steps};
  PlanarTask task_ = task(model_, GetParam().distance, GetParam().height);
  ChainProblem problem_{model_, task_, layout_};
  ChainTerms terms_{layout_.steps()};
  NonlinearProgram program_ = jump_program(model_, task_, layout_);
  RowPlaces places_{problem_};
};

}  // namespace hopscotch::planner::testing_support
