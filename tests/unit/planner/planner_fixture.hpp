#pragma once

#include <Eigen/Core>
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

inline PlanarModel shipped_model() { return {hector(), shipped_config()}; }

inline PlanarTask task(const PlanarModel& model, double distance, double height) {
  return *planar_task(model, request(distance, height));
}

/// Largest differences between a block's derivatives and central differences, relative to the size
/// of the row or Hessian that they belong to.
struct DerivativeError {
  double slopes = 0.0;
  double curvature = 0.0;
};

inline DerivativeError derivative_error(const ConstraintBlock& block, const std::vector<double>& x) {
  constexpr double kStep = 1e-6;
  const std::size_t n = x.size();
  const std::size_t m = static_cast<std::size_t>(block.rows());
  std::vector<double> multipliers(m);
  for (std::size_t r = 0; r < m; ++r) multipliers[r] = 0.3 + 0.1 * static_cast<double>(r % 7);
  constexpr double kCostFactor = 0.7;
  // Gradient of cost_factor cost + multipliers . rows, and the pieces it is made of.
  struct Point {
    double cost;
    std::vector<double> rows, cost_gradient, jacobian;
    Eigen::VectorXd lagrangian_gradient;
  };
  const auto evaluate = [&](const std::vector<double>& at) {
    Point p;
    p.rows.assign(m, 0.0);
    p.cost = block.values(at, p.rows);
    p.cost_gradient.assign(n, 0.0);
    p.jacobian.assign(n * m, 0.0);
    block.slopes(at, p.cost_gradient, p.jacobian);
    p.lagrangian_gradient = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(n));
    for (std::size_t i = 0; i < n; ++i) {
      double sum = kCostFactor * p.cost_gradient[i];
      for (std::size_t r = 0; r < m; ++r) sum += multipliers[r] * p.jacobian[r * n + i];
      p.lagrangian_gradient(static_cast<Eigen::Index>(i)) = sum;
    }
    return p;
  };
  const Point here = evaluate(x);
  std::vector<double> hessian(n * n, 0.0);
  block.curvature(x, kCostFactor, multipliers, hessian);
  DerivativeError error;
  for (std::size_t i = 0; i < n; ++i) {
    std::vector<double> ahead = x;
    std::vector<double> behind = x;
    ahead[i] += kStep;
    behind[i] -= kStep;
    const Point a = evaluate(ahead);
    const Point b = evaluate(behind);
    const auto note = [](double exact, double difference, double& worst) {
      worst = std::max(worst, std::abs(exact - difference) / (1.0 + std::abs(difference)));
    };
    note(here.cost_gradient[i], (a.cost - b.cost) / (2.0 * kStep), error.slopes);
    for (std::size_t r = 0; r < m; ++r) {
      const double exact =
          block.depends(static_cast<int>(r), static_cast<int>(i)) ? here.jacobian[r * n + i] : 0.0;
      note(exact, (a.rows[r] - b.rows[r]) / (2.0 * kStep), error.slopes);
    }
    for (std::size_t j = 0; j < n; ++j) {
      const std::size_t low = std::max(i, j);
      const std::size_t high = std::min(i, j);
      const double exact = block.curved(static_cast<int>(low), static_cast<int>(high))
                               ? hessian[low * n + high]
                               : 0.0;
      const Eigen::Index at = static_cast<Eigen::Index>(j);
      note(exact, (a.lagrangian_gradient(at) - b.lagrangian_gradient(at)) / (2.0 * kStep),
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
