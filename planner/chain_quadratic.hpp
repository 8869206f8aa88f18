#pragma once

#include <array>
#include <cmath>
#include <cstddef>

namespace hopscotch::planner {

/// z . m z / 2 + p . z with a full symmetric m; what the Riccati recursion carries along the chain.
template <std::size_t N>
struct Quadratic {
  using Row = std::array<double, N>;
  std::array<Row, N> m{};
  Row p{};

  /// Gradient by z_i at z.
  [[nodiscard]] double slope(std::size_t i, const Row& z) const {
    double sum = p[i];
    for (std::size_t j = 0; j < N; ++j) sum += m[i][j] * z[j];
    return sum;
  }
};

/// One variable as an affine function of others: z_i = row . z + offset.
template <std::size_t N>
struct Affine {
  std::array<double, N> row{};
  double offset = 0.0;

  [[nodiscard]] double at(const std::array<double, N>& z) const {
    double sum = offset;
    for (std::size_t j = 0; j < N; ++j) sum += row[j] * z[j];
    return sum;
  }
};

/// Replaces z_i by an affine function of the others (`by.row[i]` is zero).
template <std::size_t N>
void substitute(std::size_t i, const Affine<N>& by, Quadratic<N>& q) {
  for (std::size_t j = 0; j < N; ++j) q.p[j] += by.offset * q.m[j][i];
  const double slope = q.p[i];
  for (std::size_t r = 0; r < N; ++r) {
    const double factor = q.m[r][i];
    for (std::size_t j = 0; j < N; ++j) q.m[r][j] += factor * by.row[j];
    q.m[r][i] = 0.0;
  }
  const typename Quadratic<N>::Row row = q.m[i];
  for (std::size_t r = 0; r < N; ++r) {
    const double factor = by.row[r];
    q.p[r] += factor * slope;
    if (factor == 0.0) continue;
    for (std::size_t j = 0; j < N; ++j) q.m[r][j] += factor * row[j];
  }
  q.m[i] = {};
  q.p[i] = 0.0;
}

/// Minimises over z_i. @return false where the curvature by z_i is not at least `pivot_min`; q is
/// then half done.
template <std::size_t N>
[[nodiscard]] bool minimise(std::size_t i, double pivot_min, Quadratic<N>& q,
                            Affine<N>& minimiser) {
  const double pivot = q.m[i][i];
  if (!(pivot > pivot_min)) return false;
  const double inverse = 1.0 / pivot;
  for (std::size_t j = 0; j < N; ++j) minimiser.row[j] = -inverse * q.m[i][j];
  minimiser.row[i] = 0.0;
  minimiser.offset = -inverse * q.p[i];
  const typename Quadratic<N>::Row row = q.m[i];
  for (std::size_t r = 0; r < N; ++r) {
    const double factor = minimiser.row[r];
    q.p[r] += row[r] * minimiser.offset;
    for (std::size_t j = 0; j < N; ++j) q.m[r][j] += factor * row[j];
    q.m[r][i] = 0.0;
  }
  q.m[i] = {};
  q.p[i] = 0.0;
  return true;
}

/// Half of a step of constant acceleration on the slots (y, v, u) of `Dof` each:
///   y_end = y + h/2 v + h^2/8 u - gap/2,  v_end = v + h/2 u,
/// and, where the step length varies with slot `3 Dof`, its first-order effect.
template <std::size_t Dof>
struct HalfStep {
  using Coordinates = std::array<double, Dof>;
  double half = 0.0;  ///< h/2 [s]
  Coordinates half_gap{};
  Coordinates y_by_length{};  ///< Zero where the length is fixed.
  Coordinates v_by_length{};
  bool free_length = false;

  /// From the start to the end.
  template <std::size_t N>
  void push(std::array<double, N>& z) const {
    const double length = free_length ? z[3 * Dof] : 0.0;
    for (std::size_t d = 0; d < Dof; ++d) {
      const double u = z[2 * Dof + d];
      z[d] += half * (z[Dof + d] + 0.5 * half * u) + y_by_length[d] * length - half_gap[d];
      z[Dof + d] += half * u + v_by_length[d] * length;
    }
  }
  /// A linear form of the end becomes one of the start.
  template <std::size_t N>
  void pull_row(std::array<double, N>& row) const {
    const double square = 0.5 * half * half;
    if (free_length) {
      double sum = row[3 * Dof];
      for (std::size_t d = 0; d < Dof; ++d) {
        sum += y_by_length[d] * row[d] + v_by_length[d] * row[Dof + d];
      }
      row[3 * Dof] = sum;
    }
    for (std::size_t d = 0; d < Dof; ++d) {
      row[2 * Dof + d] += square * row[d] + half * row[Dof + d];
      row[Dof + d] += half * row[d];
    }
  }
  /// Constant that `row` of the end takes from the gap.
  template <std::size_t N>
  [[nodiscard]] double gap_share(const std::array<double, N>& row) const {
    double sum = 0.0;
    for (std::size_t d = 0; d < Dof; ++d) sum -= half_gap[d] * row[d];
    return sum;
  }
  template <std::size_t N>
  void pull(Quadratic<N>& q) const {
    for (std::size_t r = 0; r < N; ++r) q.p[r] += gap_share(q.m[r]);
    pull_row(q.p);
    for (std::size_t r = 0; r < N; ++r) pull_row(q.m[r]);
    const double square = 0.5 * half * half;
    if (free_length) {
      for (std::size_t d = 0; d < Dof; ++d) {
        for (std::size_t j = 0; j < N; ++j) {
          q.m[3 * Dof][j] += y_by_length[d] * q.m[d][j] + v_by_length[d] * q.m[Dof + d][j];
        }
      }
    }
    for (std::size_t d = 0; d < Dof; ++d) {
      for (std::size_t j = 0; j < N; ++j) {
        q.m[2 * Dof + d][j] += square * q.m[d][j] + half * q.m[Dof + d][j];
        q.m[Dof + d][j] += half * q.m[d][j];
      }
    }
  }
};

/// The two halves of a step, and the gradient by y in between.
template <std::size_t Dof, std::size_t N>
struct StepSweep {
  HalfStep<Dof> first;
  HalfStep<Dof> second;
  std::array<Affine<N>, Dof> middle;

  void keep_middle(const Quadratic<N>& q) {
    for (std::size_t d = 0; d < Dof; ++d) middle[d] = {q.m[d], q.p[d]};
  }
};

/// Equalities row . z + offset = 0 between slots.
template <std::size_t C, std::size_t N>
struct Equalities {
  std::array<std::array<double, N>, C> row{};
  std::array<double, C> offset{};
};

/// Solves the equalities for `C` of the slots [first, last), the largest coefficients first.
/// @return false where they do not determine any. pivots[i] is then an affine function of the slots
/// that are not pivots.
template <std::size_t C, std::size_t N>
[[nodiscard]] bool solve_for(std::size_t first, std::size_t last, Equalities<C, N> e,
                             std::array<std::size_t, C>& pivots,
                             std::array<Affine<N>, C>& solution) {
  constexpr double kPivotMin = 1e-9;
  for (std::size_t i = 0; i < C; ++i) {
    std::size_t best = first;
    for (std::size_t j = first + 1; j < last; ++j) {
      if (std::abs(e.row[i][j]) > std::abs(e.row[i][best])) best = j;
    }
    if (!(std::abs(e.row[i][best]) > kPivotMin)) return false;
    pivots[i] = best;
    const double inverse = 1.0 / e.row[i][best];
    for (double& each : e.row[i]) each *= inverse;
    e.offset[i] *= inverse;
    for (std::size_t r = 0; r < C; ++r) {
      if (r == i) continue;
      const double factor = e.row[r][best];
      for (std::size_t j = 0; j < N; ++j) e.row[r][j] -= factor * e.row[i][j];
      e.row[r][best] = 0.0;
      e.offset[r] -= factor * e.offset[i];
    }
  }
  for (std::size_t i = 0; i < C; ++i) {
    for (std::size_t j = 0; j < N; ++j) solution[i].row[j] = -e.row[i][j];
    solution[i].row[pivots[i]] = 0.0;
    solution[i].offset = -e.offset[i];
  }
  return true;
}

/// Multipliers nu of `e` from stationarity by its pivots: gradient_i + sum_r nu_r e_r,pivot_i = 0.
template <std::size_t C, std::size_t N>
[[nodiscard]] std::array<double, C> solve_multipliers(const Equalities<C, N>& e,
                                                      const std::array<std::size_t, C>& pivots,
                                                      const std::array<double, C>& gradient) {
  std::array<std::array<double, C + 1>, C> a{};
  for (std::size_t i = 0; i < C; ++i) {
    for (std::size_t r = 0; r < C; ++r) a[i][r] = e.row[r][pivots[i]];
    a[i][C] = -gradient[i];
  }
  for (std::size_t i = 0; i < C; ++i) {
    std::size_t best = i;
    for (std::size_t r = i + 1; r < C; ++r) {
      if (std::abs(a[r][i]) > std::abs(a[best][i])) best = r;
    }
    std::swap(a[i], a[best]);
    for (std::size_t r = 0; r < C; ++r) {
      if (r == i) continue;
      const double factor = a[r][i] / a[i][i];
      for (std::size_t j = i; j <= C; ++j) a[r][j] -= factor * a[i][j];
    }
  }
  std::array<double, C> nu{};
  for (std::size_t i = 0; i < C; ++i) nu[i] = a[i][C] / a[i][i];
  return nu;
}

}  // namespace hopscotch::planner
