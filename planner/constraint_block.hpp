#pragma once

#include <limits>
#include <span>

namespace hopscotch::planner {

/// Stands for "this local variable is the constant zero" in ConstraintBlock::variables().
inline constexpr int kNoVariable = -1;

/// Bound of a row or a variable that has none.
inline constexpr double kUnbounded = std::numeric_limits<double>::infinity();

/// One physical statement about a few decision variables: rows lower <= g(x) <= upper and a share
/// of the cost. A block knows its variables by position (`DecisionLayout`) and hands out exact
/// first and second derivatives with respect to them. All spans are in the block's own order.
class ConstraintBlock {
 public:
  virtual ~ConstraintBlock() = default;

  [[nodiscard]] virtual int rows() const = 0;
  /// Position of each local variable in the decision vector; kNoVariable is the constant zero.
  [[nodiscard]] virtual std::span<const int> variables() const = 0;
  /// Rows that are unbounded on both sides are left out of the problem.
  virtual void bounds(std::span<double> lower, std::span<double> upper) const = 0;

  /// May row `row` change with local variable `column`? Never depends on the values.
  [[nodiscard]] virtual bool depends(int /*row*/, int /*column*/) const { return true; }
  /// May the Hessian have an entry at (i, j)? Never depends on the values.
  [[nodiscard]] virtual bool curved(int /*i*/, int /*j*/) const { return true; }

  /// @return the cost share.
  virtual double values(std::span<const double> x, std::span<double> rows) const = 0;
  /// @param[out] cost_gradient one entry per variable
  /// @param[out] jacobian      rows x variables, row by row
  virtual void slopes(std::span<const double> x, std::span<double> cost_gradient,
                      std::span<double> jacobian) const = 0;
  /// @param[out] hessian of `cost_factor` cost + `multipliers` . rows; variables x variables, row
  ///                     by row, lower triangle.
  virtual void curvature(std::span<const double> x, double cost_factor,
                         std::span<const double> multipliers, std::span<double> hessian) const = 0;
};

}  // namespace hopscotch::planner
