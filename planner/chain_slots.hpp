#pragma once

#include <Eigen/Core>

namespace hopscotch::planner {

/// Longest steps that keep slacks and multipliers positive.
struct StepLimits {
  double primal = 1.0;
  double dual = 1.0;
};

/// Slacks of all inequalities, lower <= s <= upper, with the multipliers of both sides: the barrier
/// part of an interior-point method. A side without bound has multiplier zero and no barrier. Sized
/// once; nothing allocates afterwards.
class ChainSlots {
 public:
  explicit ChainSlots(int slots);

  /// Takes the bounds, one or both infinite where there is none.
  void set_bounds(const Eigen::VectorXd& lower, const Eigen::VectorXd& upper);
  /// Slacks next to `values` but inside of the bounds by `push` (of the range or the bound's size),
  /// multipliers that make slack times multiplier equal `barrier`.
  void start(const Eigen::VectorXd& values, double push, double barrier);
  /// The same, but keeping multipliers where they fit: each product within `spread` of `barrier`.
  void restart(const Eigen::VectorXd& values, double push, double barrier, double spread);

  /// Takes multipliers of a former solution, as `multiplier()` gave them; `restart` goes on from
  /// them.
  void recall(const Eigen::VectorXd& multiplier);

  [[nodiscard]] const Eigen::VectorXd& slack() const { return slack_; }
  /// Upper minus lower multiplier: the factor of each slot in the Lagrangian.
  [[nodiscard]] const Eigen::VectorXd& multiplier() const { return multiplier_; }
  /// Curvature of the condensed barrier by each slot.
  [[nodiscard]] const Eigen::VectorXd& weight() const { return weight_; }
  [[nodiscard]] double sides() const { return sides_; }

  /// Nearest value to v that is inside of the bounds of slot i by `push`.
  [[nodiscard]] double inside(int i, double v, double push) const;

  /// Computes weight(); call after every change of slacks or multipliers.
  void update_weights();
  /// Gradient of the condensed barrier by each slot: target - with residual = value - slack.
  void slopes(double barrier, const Eigen::VectorXd& residual, Eigen::VectorXd& out) const;
  /// Largest |slack times multiplier - barrier|, and the mean product.
  [[nodiscard]] double complementarity(double barrier) const;
  [[nodiscard]] double mean_product() const;
  [[nodiscard]] double multiplier_sum() const;
  /// -sum of the logarithms of all gaps of slack + step change.
  [[nodiscard]] double barrier_value(double step, const Eigen::VectorXd& change) const;
  /// Derivative of barrier_value by step at 0.
  [[nodiscard]] double barrier_slope(const Eigen::VectorXd& change) const;
  /// Newton steps of the multipliers for a change of the slacks; the steps are kept for `move`.
  StepLimits find_step(const Eigen::VectorXd& change, double barrier, double keep);
  void move(double primal, double dual, const Eigen::VectorXd& change, double barrier);

 private:
  Eigen::VectorXd lower_;
  Eigen::VectorXd upper_;
  Eigen::VectorXd has_lower_;  ///< 1 or 0.
  Eigen::VectorXd has_upper_;
  Eigen::VectorXd slack_;
  Eigen::VectorXd at_lower_;  ///< Multipliers.
  Eigen::VectorXd at_upper_;
  Eigen::VectorXd lower_step_;
  Eigen::VectorXd upper_step_;
  Eigen::VectorXd multiplier_;
  Eigen::VectorXd weight_;
  double sides_ = 0.0;
};

}  // namespace hopscotch::planner
