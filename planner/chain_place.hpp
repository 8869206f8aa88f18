#pragma once

#include <Eigen/Core>
#include <array>

#include "planner/chain_step.hpp"
#include "planner/constraint_block.hpp"
#include "planner/step_shift.hpp"

namespace hopscotch::planner {

/// Where a step finds its variables, and how it stands at a point.
template <int Dof>
struct StepPlace {
  std::array<int, 4 * static_cast<std::size_t>(Dof)> at{};  ///< y0, v0, y1, v1.
  int length_at = kNoVariable;                              ///< Variable s of a free step.
  double length = 0.0;                                      ///< h, or the share of s.
  StepShift<Dof> shift;
};
template <int Dof>
struct StepPoint {
  using Coordinates = std::array<double, static_cast<std::size_t>(Dof)>;
  double h = 0.0;             ///< [s]
  Coordinates rate{};         ///< v0 [rad/s]
  Coordinates middle_rate{};  ///< [rad/s]
  Coordinates acceleration{};
  Coordinates gap{};  ///< y1 - y0 - h (v0 + v1) / 2 - turn
  /// Second derivatives of the Lagrangian by h that come from the mid-point's dependence on it:
  /// with v0, with u and twice.
  Coordinates by_rate{};
  Coordinates by_acceleration{};
  double by_length = 0.0;
};

/// One step with all its derivatives.
template <int Dof>
struct StepExpansion {
  StepPoint<Dof> point;
  StepTerms<Dof> terms;
};

template <int Dof>
[[nodiscard]] StepPoint<Dof> point_of(const StepPlace<Dof>& place, const Eigen::VectorXd& x) {
  constexpr std::size_t kDof = static_cast<std::size_t>(Dof);
  StepPoint<Dof> p;
  p.h = place.length_at == kNoVariable ? place.length : place.length * x(place.length_at);
  for (std::size_t d = 0; d < kDof; ++d) {
    const double v0 = x(place.at[kDof + d]);
    const double v1 = x(place.at[3 * kDof + d]);
    p.rate[d] = v0;
    p.middle_rate[d] = 0.5 * (v0 + v1);
    p.acceleration[d] = (v1 - v0) / p.h;
    p.gap[d] =
        x(place.at[2 * kDof + d]) - x(place.at[d]) - p.h * p.middle_rate[d] - place.shift.turn[d];
  }
  return p;
}

/// (y, v, u, h) at the mid-point.
template <int Dof>
typename StepTerms<Dof>::Slope middle_of(const StepPlace<Dof>& place, const StepPoint<Dof>& p,
                                         const Eigen::VectorXd& x) {
  constexpr std::size_t kDof = static_cast<std::size_t>(Dof);
  typename StepTerms<Dof>::Slope middle;
  for (std::size_t d = 0; d < kDof; ++d) {
    middle[d] =
        0.5 * (x(place.at[d]) + x(place.at[2 * kDof + d])) - 0.125 * p.h * p.h * p.acceleration[d];
    middle[kDof + d] = p.middle_rate[d];
    middle[2 * kDof + d] = p.acceleration[d] + place.shift.acceleration[d];
  }
  middle[3 * kDof] = p.h;
  return middle;
}

/// Rows of a step's law into the slots, its gaps into the equalities. @return the cost share.
template <int Dof, typename Law>
double step_values(const Law& law, const StepPlace<Dof>& place, const Eigen::VectorXd& x,
                   double* rows, double* gaps) {
  const StepPoint<Dof> point = point_of(place, x);
  std::array<double, static_cast<std::size_t>(Law::kRows)> out;
  const double cost = law(middle_of(place, point, x), out);
  std::copy(out.begin(), out.end(), rows);
  std::copy(point.gap.begin(), point.gap.end(), gaps);
  return cost;
}

/// Where a step is expanded: a point, and the multipliers of its rows and gaps.
struct StepQuery {
  const Eigen::VectorXd& x;
  const double* rows = nullptr;
  const double* gaps = nullptr;
};

template <int Dof>
void expand_step(const ChainStep<Dof>& step, const StepObjective& objective,
                 const StepPlace<Dof>& place, const StepQuery& at, StepExpansion<Dof>& out) {
  constexpr std::size_t kDof = static_cast<std::size_t>(Dof);
  using Terms = StepTerms<Dof>;
  out.point = point_of(place, at.x);
  std::array<double, Terms::kRows> multipliers;
  std::copy_n(at.rows, Terms::kRows, multipliers.begin());
  step.expand(objective, middle_of(place, out.point, at.x), multipliers, out.terms);
  if (place.length_at == kNoVariable) return;
  StepPoint<Dof>& p = out.point;
  p.by_length = 0.0;
  for (std::size_t d = 0; d < kDof; ++d) {
    double by_y = out.terms.gradient[d];
    double by_u = out.terms.gradient[2 * kDof + d];
    for (std::size_t r = 0; r < Terms::kRows; ++r) {
      by_y += multipliers[r] * out.terms.slope[r][d];
      by_u += multipliers[r] * out.terms.slope[r][2 * kDof + d];
    }
    p.by_rate[d] = -at.gaps[d];
    p.by_acceleration[d] = -p.h * (0.125 * by_y + 0.5 * at.gaps[d]) - by_u / p.h;
    p.by_length -= p.acceleration[d] * (0.25 * by_y + at.gaps[d]);
  }
}

/// Adds the derivatives by both ends of a step: of the law by `middle`, of the gaps by `gaps`.
template <int Dof>
void scatter_step(const StepPlace<Dof>& place, const StepPoint<Dof>& p,
                  const typename StepTerms<Dof>::Slope& middle, const double* gaps,
                  Eigen::VectorXd& out) {
  constexpr std::size_t kDof = static_cast<std::size_t>(Dof);
  double by_length = middle[3 * kDof];
  for (std::size_t d = 0; d < kDof; ++d) {
    const double y = middle[d];
    const double v = middle[kDof + d];
    const double u = middle[2 * kDof + d];
    const double difference = u / p.h - 0.125 * p.h * y;
    const double mean = 0.5 * (v - p.h * gaps[d]);
    out(place.at[d]) += 0.5 * y - gaps[d];
    out(place.at[kDof + d]) += mean - difference;
    out(place.at[2 * kDof + d]) += 0.5 * y + gaps[d];
    out(place.at[3 * kDof + d]) += mean + difference;
    by_length -= p.acceleration[d] * (0.125 * p.h * y + u / p.h) + p.middle_rate[d] * gaps[d];
  }
  if (place.length_at != kNoVariable) out(place.length_at) += place.length * by_length;
}

template <int Dof>
void step_gradient(const StepExpansion<Dof>& step, const StepPlace<Dof>& place, const double* rows,
                   const double* gaps, Eigen::VectorXd& out) {
  typename StepTerms<Dof>::Slope middle = step.terms.gradient;
  for (std::size_t r = 0; r < StepTerms<Dof>::kRows; ++r) {
    for (std::size_t i = 0; i < middle.size(); ++i) middle[i] += rows[r] * step.terms.slope[r][i];
  }
  scatter_step(place, step.point, middle, gaps, out);
}

/// Change of a step's rows along a direction.
template <int Dof>
void step_along(const StepExpansion<Dof>& step, const StepPlace<Dof>& place,
                const Eigen::VectorXd& direction, double* rows) {
  constexpr std::size_t kDof = static_cast<std::size_t>(Dof);
  const StepPoint<Dof>& p = step.point;
  const double dh =
      place.length_at == kNoVariable ? 0.0 : place.length * direction(place.length_at);
  typename StepTerms<Dof>::Slope change;
  for (std::size_t d = 0; d < kDof; ++d) {
    const double v0 = direction(place.at[kDof + d]);
    const double v1 = direction(place.at[3 * kDof + d]);
    change[d] = 0.5 * (direction(place.at[d]) + direction(place.at[2 * kDof + d])) -
                0.125 * p.h * (v1 - v0 + p.acceleration[d] * dh);
    change[kDof + d] = 0.5 * (v0 + v1);
    change[2 * kDof + d] = (v1 - v0 - p.acceleration[d] * dh) / p.h;
  }
  change[3 * kDof] = dh;
  for (std::size_t r = 0; r < StepTerms<Dof>::kRows; ++r) {
    double sum = 0.0;
    for (std::size_t i = 0; i < change.size(); ++i) sum += step.terms.slope[r][i] * change[i];
    rows[r] = sum;
  }
}

}  // namespace hopscotch::planner
