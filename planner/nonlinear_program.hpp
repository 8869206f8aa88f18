#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "planner/constraint_block.hpp"

namespace hopscotch::planner {

/// Place of a structural non-zero.
struct SparseEntry {
  int row = 0;
  int column = 0;
  auto operator<=>(const SparseEntry&) const = default;
};

/// The sum of the blocks as one sparse problem: minimise f(x), lower <= g(x) <= upper. Knows no
/// solver. Entries of different blocks at the same place are added up.
class NonlinearProgram {
 public:
  NonlinearProgram(int variables, std::vector<std::unique_ptr<ConstraintBlock>> blocks);

  [[nodiscard]] int variables() const { return variables_; }
  [[nodiscard]] int rows() const { return static_cast<int>(lower_.size()); }
  [[nodiscard]] const Eigen::VectorXd& row_lower() const { return lower_; }
  [[nodiscard]] const Eigen::VectorXd& row_upper() const { return upper_; }
  /// Replaces the bounds of a row.
  void bound_row(int row, double lower, double upper) {
    lower_(row) = lower;
    upper_(row) = upper;
  }
  [[nodiscard]] const std::vector<SparseEntry>& jacobian_pattern() const { return jacobian_; }
  /// Lower triangle.
  [[nodiscard]] const std::vector<SparseEntry>& hessian_pattern() const { return hessian_; }

  /// Cost and rows at x. @return f(x)
  double values(const double* x, Eigen::VectorXd& rows) const;
  /// Gradient of f and the values of the Jacobian, in the order of its pattern.
  void slopes(const double* x, Eigen::VectorXd& cost_gradient, Eigen::VectorXd& jacobian) const;
  /// Values of the Hessian of cost_factor f + multipliers . g, in the order of its pattern.
  void curvature(const double* x, double cost_factor, const double* multipliers,
                 Eigen::VectorXd& hessian) const;

 private:
  /// A non-zero of a block: where it is in the block's dense matrix, where in the values.
  struct Link {
    int local = 0;
    int global = 0;
  };
  struct Placed {
    std::unique_ptr<ConstraintBlock> block;
    std::vector<int> rows;  ///< Row of the problem, or -1 for a row that is left out.
    std::vector<Link> jacobian;
    std::vector<Link> hessian;
  };
  void place_rows(Placed& placed);
  void collect_patterns();
  void link(Placed& placed) const;
  static void gather(const ConstraintBlock& block, const double* x, std::vector<double>& local);

  int variables_;
  std::vector<Placed> blocks_;
  Eigen::VectorXd lower_;
  Eigen::VectorXd upper_;
  std::vector<SparseEntry> jacobian_;
  std::vector<SparseEntry> hessian_;
};

}  // namespace hopscotch::planner
