#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <random>
#include <vector>

#include "core/config_reader.hpp"
#include "model/stand_posture.hpp"
#include "planner/constraint_block.hpp"
#include "planner/jump_planner.hpp"
#include "planner/planar_task.hpp"
#include "planner/step_target.hpp"

namespace hopscotch::planner::testing_support {

inline std::filesystem::path config_folder() {
  return std::filesystem::path(HOPSCOTCH_SOURCE_DIR) / "config";
}

inline model::RobotParameters hector() {
  return model::RobotParameters::load(config_folder() / "robots" / "hector.yaml");
}

/// The shipped tuning; other sections of the file belong to other folders.
inline PlannerConfig shipped_config() {
  return PlannerConfig::load(
      core::ConfigReader::from_file(config_folder() / "hopscotch.yaml").section("planner"));
}

inline model::StandPosture shipped_posture() {
  return model::StandPosture::load(core::ConfigReader::from_file(config_folder() / "hopscotch.yaml")
                                       .section("model")
                                       .section("stand_posture"));
}

/// A jump from standing at the origin of W.
inline PlanRequest request(double distance, double height) {
  const model::RobotParameters robot = hector();
  PlanRequest request;
  request.final_posture = shipped_posture();
  request.start = standing_state(*model::stand_pose(robot, request.final_posture));
  request.target = step_target(
      {.distance = distance, .height = height, .edge = default_edge(distance, height)}, robot);
  request.id = 7;
  return request;
}

inline PlanarModel shipped_model() {
  return {hector(), shipped_config()};
}

inline PlanarTask task(const PlanarModel& model, double distance, double height) {
  return *planar_task(model, request(distance, height));
}

/// Largest differences between a block's derivatives and central differences, relative to the size
/// of the row or Hessian that they belong to.
struct DerivativeError {
  double slopes = 0.0;
  double curvature = 0.0;
};

/// A block's rows and slopes at one point, with the gradient of 0.7 cost + multipliers . rows.
struct BlockPoint {
  double cost = 0.0;
  std::vector<double> rows;
  std::vector<double> cost_gradient;
  std::vector<double> jacobian;  ///< Row by row.
  std::vector<double> lagrangian_gradient;
};
inline constexpr double kCostFactor = 0.7;

inline std::vector<double> test_multipliers(const ConstraintBlock& block) {
  std::vector<double> multipliers;
  multipliers.reserve(static_cast<std::size_t>(block.rows()));
  for (int r = 0; r < block.rows(); ++r) multipliers.push_back(0.3 + 0.1 * (r % 7));
  return multipliers;
}

inline BlockPoint evaluate(const ConstraintBlock& block, const std::vector<double>& x) {
  const std::vector<double> multipliers = test_multipliers(block);
  BlockPoint point;
  point.rows.assign(multipliers.size(), 0.0);
  point.cost = block.values(x, point.rows);
  point.cost_gradient.assign(x.size(), 0.0);
  point.jacobian.assign(x.size() * multipliers.size(), 0.0);
  block.slopes(x, point.cost_gradient, point.jacobian);
  for (std::size_t i = 0; i < x.size(); ++i) {
    double sum = kCostFactor * point.cost_gradient[i];
    for (std::size_t r = 0; r < multipliers.size(); ++r) {
      sum += multipliers[r] * point.jacobian[r * x.size() + i];
    }
    point.lagrangian_gradient.push_back(sum);
  }
  return point;
}

inline void note_error(double exact, double difference, double& worst) {
  worst = std::max(worst, std::abs(exact - difference) / (1.0 + std::abs(difference)));
}

inline DerivativeError derivative_error(const ConstraintBlock& block,
                                        const std::vector<double>& x) {
  constexpr double kStep = 1e-6;
  const std::size_t n = x.size();
  const BlockPoint here = evaluate(block, x);
  std::vector<double> hessian(n * n, 0.0);
  block.curvature(x, kCostFactor, test_multipliers(block), hessian);
  DerivativeError error;
  for (std::size_t i = 0; i < n; ++i) {
    std::vector<double> shifted = x;
    shifted[i] = x[i] + kStep;
    const BlockPoint a = evaluate(block, shifted);
    shifted[i] = x[i] - kStep;
    const BlockPoint b = evaluate(block, shifted);
    note_error(here.cost_gradient[i], (a.cost - b.cost) / (2.0 * kStep), error.slopes);
    for (std::size_t r = 0; r < here.rows.size(); ++r) {
      const bool depends = block.depends(static_cast<int>(r), static_cast<int>(i));
      note_error(depends ? here.jacobian[r * n + i] : 0.0, (a.rows[r] - b.rows[r]) / (2.0 * kStep),
                 error.slopes);
    }
    for (std::size_t j = 0; j < n; ++j) {
      const std::size_t low = std::max(i, j);
      const std::size_t high = std::min(i, j);
      const bool curved = block.curved(static_cast<int>(low), static_cast<int>(high));
      note_error(curved ? hessian[low * n + high] : 0.0,
                 (a.lagrangian_gradient[j] - b.lagrangian_gradient[j]) / (2.0 * kStep),
                 error.curvature);
    }
  }
  return error;
}

/// Central differences of exact first derivatives with a step of 1e-6.
inline constexpr double kDerivativeTolerance = 2e-5;

/// Numbers in [-1, 1], the same in every run.
inline std::vector<double> random_point(std::size_t size, unsigned seed) {
  std::mt19937 generator(seed);
  std::uniform_real_distribution<double> spread(-1.0, 1.0);
  std::vector<double> x(size);
  for (double& each : x) each = spread(generator);
  return x;
}

}  // namespace hopscotch::planner::testing_support
