#pragma once

#include <vector>

#include "control/wrench_qp.hpp"

/// An independent reading of WrenchQp for tests: condensed to the inputs of the feet in contact,
/// from 12x12 matrices, in long double. Shares nothing with the solver.
namespace hopscotch::control::testing {

using Real = long double;
using DenseVector = Eigen::Matrix<Real, Eigen::Dynamic, 1>;
using DenseMatrix = Eigen::Matrix<Real, Eigen::Dynamic, Eigen::Dynamic>;

/// Where a foot's five inputs stand among the variables.
struct DenseFoot {
  int step = 0;
  core::Leg leg = core::Leg::left;
  Eigen::Index first = 0;
};

/// min 1/2 z'Hz + g'z + constant  subject to  A z + b >= 0, z = the inputs of all feet in contact.
struct DenseQp {
  DenseMatrix H;
  DenseVector g;
  Real constant = 0.0L;
  DenseMatrix A;
  DenseVector b;
  std::vector<DenseFoot> feet;
  /// States at knots 1 to h are `free` + `gain` z, 12 rows each.
  DenseMatrix gain;
  DenseVector free;

  [[nodiscard]] Real objective(const DenseVector& z) const;
};

[[nodiscard]] DenseQp condense(const WrenchQp& qp);

/// Minimiser by an infeasible-start interior point on the dense problem.
[[nodiscard]] DenseVector solve_dense(const DenseQp& qp);

/// Largest breach of each optimality condition. All four zero proves the optimum, since the
/// problem is strictly convex.
struct KktResiduals {
  double stationarity = 0.0;     ///< |H z + g - A' lambda|
  double primal = 0.0;           ///< max(0, -(A z + b)) [N, N·m]
  double dual = 0.0;             ///< max(0, -lambda)
  double complementarity = 0.0;  ///< sum |lambda (A z + b)|
};
[[nodiscard]] KktResiduals kkt_residuals(const DenseQp& qp, const DenseVector& z,
                                         const DenseVector& lambda);

}  // namespace hopscotch::control::testing
