#pragma once

#include "planner/chain_kkt.hpp"

namespace hopscotch::planner::kkt {

/// Pieces of the sweeps of ChainKkt; not for others.

/// Reduced curvature of a scaled variable below which the Hessian counts as not positive.
inline constexpr double kPivotMin = 1e-10;

template <int Dof>
inline constexpr std::size_t kD = static_cast<std::size_t>(Dof);

/// The two halves of a step: start to middle, middle to end.
template <int Dof, std::size_t N>
void split_step(const StepPoint<Dof>& p, const double* gap, double share,
                StepSweep<kD<Dof>, N>& sweep) {
  for (HalfStep<kD<Dof>>* half : {&sweep.first, &sweep.second}) {
    half->half = 0.5 * p.h;
    half->free_length = share > 0.0;
    for (std::size_t d = 0; d < kD<Dof>; ++d) {
      const double rate = half == &sweep.first ? p.rate[d] : p.middle_rate[d];
      half->half_gap[d] = 0.5 * gap[d];
      half->y_by_length[d] = share * (0.5 * rate + 0.25 * p.h * p.acceleration[d]);
      half->v_by_length[d] = share * 0.5 * p.acceleration[d];
    }
  }
}

/// The multiplier of a step's gap by coordinate d, from the gradients in its middle and at its end.
inline double gap_multiplier(double middle, double end) {
  return -0.5 * (middle + end);
}

/// The barrier's share of a step's rows, and how much of the indefinite curvature is taken.
struct StepBarrier {
  double curvature = 1.0;
  const double* weight = nullptr;
  const double* slope = nullptr;

  StepBarrier(const KktInput& input, int first)
      : curvature(input.curvature),
        weight(input.slot_weights->data() + first),
        slope(input.slot_slopes->data() + first) {}
};

/// Adds a step's own terms at its mid-point; its length is slot 3 Dof times `share`, 0 if fixed.
template <int Dof, std::size_t N>
void add_step(const StepTerms<Dof>& terms, double share, const StepBarrier& barrier,
              Quadratic<N>& q) {
  constexpr std::size_t kSize = 3 * kD<Dof>;
  typename StepTerms<Dof>::Slope gradient = terms.gradient;
  std::array<typename StepTerms<Dof>::Slope, kSize + 1> hessian = terms.convex;
  for (std::size_t i = 0; i <= kSize; ++i) {
    for (std::size_t j = 0; j <= kSize; ++j)
      hessian[i][j] += barrier.curvature * terms.curvature[i][j];
  }
  for (std::size_t r = 0; r < StepTerms<Dof>::kRows; ++r) {
    const typename StepTerms<Dof>::Slope& row = terms.slope[r];
    for (std::size_t i = 0; i <= kSize; ++i) {
      gradient[i] += barrier.slope[r] * row[i];
      const double factor = barrier.weight[r] * row[i];
      for (std::size_t j = 0; j <= kSize; ++j) hessian[i][j] += factor * row[j];
    }
  }
  for (std::size_t i = 0; i < kSize; ++i) {
    q.p[i] += gradient[i];
    for (std::size_t j = 0; j < kSize; ++j) q.m[i][j] += hessian[i][j];
  }
  if (share == 0.0) return;  // fixed length
  for (std::size_t i = 0; i < kSize; ++i) {
    q.m[i][kSize] += share * hessian[i][kSize];
    q.m[kSize][i] += share * hessian[i][kSize];
  }
  q.m[kSize][kSize] += share * share * hessian[kSize][kSize];
  q.p[kSize] += share * gradient[kSize];
}

/// Second derivatives by the step length that stem from the mid-point.
template <int Dof, std::size_t N>
void add_length_curvature(const StepPoint<Dof>& p, double factor, double share, Quadratic<N>& q) {
  constexpr std::size_t kLength = 3 * kD<Dof>;
  for (std::size_t d = 0; d < kD<Dof>; ++d) {
    const double by_rate = factor * share * p.by_rate[d];
    const double by_acceleration = factor * share * p.by_acceleration[d];
    q.m[kD<Dof> + d][kLength] += by_rate;
    q.m[kLength][kD<Dof> + d] += by_rate;
    q.m[2 * kD<Dof> + d][kLength] += by_acceleration;
    q.m[kLength][2 * kD<Dof> + d] += by_acceleration;
  }
  q.m[kLength][kLength] += factor * share * share * p.by_length;
}

/// weight (a . z)^2 / 2 + slope a . z
template <std::size_t N>
void add_form(double weight, double slope, const std::array<std::pair<std::size_t, double>, 4>& a,
              Quadratic<N>& q) {
  for (const auto& [i, ai] : a) {
    q.p[i] += slope * ai;
    for (const auto& [j, aj] : a) q.m[i][j] += weight * ai * aj;
  }
}

/// The joint rows of a knot in slots y, v from 0 on.
template <int Dof, std::size_t N>
void add_joints(const JointRows<Dof>& joints, const double* weight, const double* slope,
                Quadratic<N>& q) {
  constexpr std::size_t kY = 0;
  constexpr std::size_t kV = kD<Dof>;
  const double hip = 1.0 / joints.hip_speed;
  const double ankle = 1.0 / joints.ankle_speed;
  add_form(weight[0], slope[0], {{{kY, 1.0}, {kY + 1, -1.0}, {kY + 2, -1.0}, {kY, 0.0}}}, q);
  add_form(weight[1], slope[1], {{{kV, hip}, {kV + 1, -hip}, {kV + 2, -hip}, {kV, 0.0}}}, q);
  if constexpr (Dof == kFlightDof) {
    add_form(weight[2], slope[2], {{{kV, -ankle}, {kV + 1, ankle}, {kV + 3, ankle}, {kV, 0.0}}}, q);
    add_form(weight[3], slope[3], {{{kY, -1.0}, {kY + 3, 1.0}, {kY, 0.0}, {kY, 0.0}}}, q);
  } else {
    add_form(weight[2], slope[2], {{{kV, -ankle}, {kV + 1, ankle}, {kV, 0.0}, {kV, 0.0}}}, q);
  }
}

/// Bounds and regularisation of single variables.
struct Diagonal {
  const ChainProblem& problem;
  const KktInput& input;

  template <std::size_t N>
  void add(int variable, std::size_t slot, Quadratic<N>& q) const {
    const int at = problem.layout().variable(variable);
    const double size = problem.sizes()(variable);
    q.m[slot][slot] += (*input.slot_weights)(at) + input.regularisation / (size * size);
    q.p[slot] += (*input.slot_slopes)(at);
  }
  template <std::size_t N>
  void add_range(int first, int count, std::size_t slot, Quadratic<N>& q) const {
    for (int i = 0; i < count; ++i) add(first + i, slot + static_cast<std::size_t>(i), q);
  }
};

/// Adds a lower-triangle Hessian and rows with weights; slot of local variable i is `to[i]`.
template <std::size_t L, std::size_t N>
void add_lower(const std::array<double, L * L>& lower, double factor,
               const std::array<std::size_t, L>& to, Quadratic<N>& q) {
  for (std::size_t i = 0; i < L; ++i) {
    for (std::size_t j = 0; j <= i; ++j) {
      const double value = factor * lower[i * L + j];
      q.m[to[i]][to[j]] += value;
      if (i != j) q.m[to[j]][to[i]] += value;
    }
  }
}

template <std::size_t N>
void put(const std::array<double, N>& z, std::size_t from, int count, int at, Eigen::VectorXd& dx) {
  for (int i = 0; i < count; ++i) dx(at + i) = z[from + static_cast<std::size_t>(i)];
}

/// Slots of a flight stage.
inline constexpr std::size_t kFlightLength = 12;
inline constexpr std::size_t kFlightCom = 13;
inline constexpr std::size_t kFlightMomentum = 17;
inline constexpr std::size_t kLandingLength = 9;
/// Slots of the touchdown.
inline constexpr std::size_t kAfter = 7;
inline constexpr std::size_t kTouchdownCom = 10;
inline constexpr std::size_t kTouchdownFlightStep = 14;
inline constexpr std::size_t kTouchdownLandingStep = 15;

/// Slot of a flight stage for each of the first 15 of the touchdown but the rates after it.
inline constexpr std::array<std::size_t, 15> kTouchdownToFlight{0, 1, 2,  4,  5,  6,  7, 0,
                                                                0, 0, 13, 14, 15, 16, 12};
constexpr bool is_after(std::size_t slot) {
  return slot >= kAfter && slot < kTouchdownCom;
}

}  // namespace hopscotch::planner::kkt
