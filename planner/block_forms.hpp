#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>

#include "planner/constraint_block.hpp"
#include "planner/differentiation.hpp"
#include "planner/step_shift.hpp"

namespace hopscotch::planner {

/// A law is a struct with
///   static constexpr int kRows;
///   template <typename T> T operator()(const std::array<T, N>& x, std::array<T, kRows>& rows)
///   const;                                       // returns the cost share
///   void bounds(std::span<double> lower, std::span<double> upper) const;
/// The two forms below turn a law into a block: `KnotBlock` feeds it decision variables,
/// `StepBlock` the mid-point of a step between two knots.

namespace detail {

/// `cost_factor` cost + `multipliers` . rows
template <typename T, std::size_t R>
T lagrangian(const T& cost, double cost_factor, const std::array<T, R>& rows,
             std::span<const double> multipliers) {
  T sum = cost * cost_factor;
  for (std::size_t r = 0; r < R; ++r) {
    if (multipliers[r] != 0.0) sum = sum + rows[r] * multipliers[r];
  }
  return sum;
}

template <typename T, std::size_t N>
std::array<T, N> seeded(std::span<const double> x) {
  std::array<T, N> seeds;
  for (std::size_t i = 0; i < N; ++i) seeds[i] = T::variable(x[i], static_cast<int>(i));
  return seeds;
}

}  // namespace detail

/// A law of N decision variables.
template <typename Law, int N>
class KnotBlock final : public ConstraintBlock {
 public:
  static constexpr std::size_t kSize = static_cast<std::size_t>(N);
  static constexpr std::size_t kRowCount = static_cast<std::size_t>(Law::kRows);

  KnotBlock(Law law, const std::array<int, kSize>& variables)
      : law_(std::move(law)), variables_(variables) {}

  [[nodiscard]] int rows() const override { return Law::kRows; }
  [[nodiscard]] std::span<const int> variables() const override { return variables_; }
  void bounds(std::span<double> lower, std::span<double> upper) const override {
    law_.bounds(lower, upper);
  }
  [[nodiscard]] bool depends(int row, int column) const override {
    if constexpr (requires { Law::depends(row, column); }) return Law::depends(row, column);
    return true;
  }
  [[nodiscard]] bool curved(int i, int j) const override {
    if constexpr (requires { Law::curved(i, j); }) return Law::curved(i, j);
    return true;
  }

  double values(std::span<const double> x, std::span<double> rows) const override {
    std::array<double, kSize> point;
    std::copy(x.begin(), x.end(), point.begin());
    std::array<double, kRowCount> out;
    const double cost = law_(point, out);
    std::copy(out.begin(), out.end(), rows.begin());
    return cost;
  }

  void slopes(std::span<const double> x, std::span<double> cost_gradient,
              std::span<double> jacobian) const override {
    using T = FirstOrder<kSize>;
    std::array<T, kRowCount> out;
    const T cost = law_(detail::seeded<T, kSize>(x), out);
    std::copy(cost.gradient.begin(), cost.gradient.end(), cost_gradient.begin());
    auto next = jacobian.begin();
    for (const T& row : out) next = std::copy(row.gradient.begin(), row.gradient.end(), next);
  }

  void curvature(std::span<const double> x, double cost_factor, std::span<const double> multipliers,
                 std::span<double> hessian) const override {
    using T = SecondOrder<kSize>;
    std::array<T, kRowCount> out;
    const T cost = law_(detail::seeded<T, kSize>(x), out);
    const T sum = detail::lagrangian(cost, cost_factor, out, multipliers);
    std::size_t k = 0;
    for (std::size_t i = 0; i < kSize; ++i) {
      for (std::size_t j = 0; j <= i; ++j) hessian[i * kSize + j] = sum.hessian[k++];
    }
  }

 private:
  Law law_;
  std::array<int, kSize> variables_;
};

/// How long a step is: a constant, or a constant share of the last local variable.
enum class StepLength { fixed, free };

/// A law of the mid-point of a step between two knots (y, v) of `Dof` positions and rates:
/// acceleration u = (v1 - v0) / h is constant, so the law sees
///   y_mid = (y0 + y1) / 2 - h (v1 - v0) / 8,  v_mid = (v0 + v1) / 2,  u  and  h
/// as its 3 Dof + 1 arguments, and the first Dof rows of the block are the trapezoid
///   y1 - y0 - h (v0 + v1) / 2 = 0, which is exact for constant acceleration.
/// A `StepShift` adds its constants to u and to the right side.
/// Local variables: y0, v0, y1, v1 and, when free, s with h = share s.
template <typename Law, int Dof, StepLength kLength>
class StepBlock final : public ConstraintBlock {
 public:
  static constexpr int kVariables = 4 * Dof + (kLength == StepLength::free ? 1 : 0);
  static constexpr int kArguments = 3 * Dof + 1;
  /// Arguments that vary: all but a fixed h.
  static constexpr int kMiddle = kVariables == 4 * Dof ? 3 * Dof : kArguments;
  static constexpr int kRowTotal = Dof + Law::kRows;

  /// @param step Length h of a fixed step [s], or the share of a free one [-].
  StepBlock(Law law, const std::array<int, static_cast<std::size_t>(kVariables)>& variables,
            double step, const StepShift<Dof>& shift = {})
      : law_(std::move(law)), variables_(variables), step_(step), shift_(shift) {}

  [[nodiscard]] int rows() const override { return kRowTotal; }
  [[nodiscard]] std::span<const int> variables() const override { return variables_; }

  void bounds(std::span<double> lower, std::span<double> upper) const override {
    std::copy(shift_.turn.begin(), shift_.turn.end(), lower.begin());
    std::copy(shift_.turn.begin(), shift_.turn.end(), upper.begin());
    law_.bounds(lower.subspan(Dof), upper.subspan(Dof));
  }

  /// The trapezoid of one coordinate touches only that coordinate and h.
  [[nodiscard]] bool depends(int row, int column) const override {
    return row >= Dof || column == 4 * Dof || column % Dof == row;
  }

  double values(std::span<const double> x, std::span<double> rows) const override {
    const double h = length(x);
    for (int i = 0; i < Dof; ++i)
      rows[at(i)] = y1(x, i) - y0(x, i) - 0.5 * h * (v0(x, i) + v1(x, i));
    std::array<double, kArgumentSize> middle;
    for (int i = 0; i < kArguments; ++i) middle[at(i)] = middle_value(x, h, i);
    std::array<double, kLawRows> out;
    const double cost = law_(middle, out);
    std::copy(out.begin(), out.end(), rows.begin() + Dof);
    return cost;
  }

  void slopes(std::span<const double> x, std::span<double> cost_gradient,
              std::span<double> jacobian) const override {
    const double h = length(x);
    using T = FirstOrder<kMiddleSize>;
    std::array<T, kLawRows> out;
    const T cost = law_(seeded_middle<T>(x, h), out);
    const Chain chain = chain_rule(x, h, step_);
    Eigen::Map<Eigen::RowVector<double, kVariables>>(cost_gradient.data()) =
        gradient_row(cost) * chain;
    trapezoid_slopes(x, h, step_, jacobian);
    for (int r = 0; r < Law::kRows; ++r) {
      Eigen::Map<Eigen::RowVector<double, kVariables>>(jacobian.data() + (Dof + r) * kVariables) =
          gradient_row(out[at(r)]) * chain;
    }
  }

  void curvature(std::span<const double> x, double cost_factor, std::span<const double> multipliers,
                 std::span<double> hessian) const override {
    const double h = length(x);
    using T = SecondOrder<kMiddleSize>;
    std::array<T, kLawRows> out;
    const T cost = law_(seeded_middle<T>(x, h), out);
    const T sum = detail::lagrangian(cost, cost_factor, out, multipliers.subspan(Dof));
    Eigen::Matrix<double, kMiddle, kMiddle> inner;
    std::size_t k = 0;
    for (int i = 0; i < kMiddle; ++i) {
      for (int j = 0; j <= i; ++j) inner(i, j) = inner(j, i) = sum.hessian[k++];
    }
    const Chain chain = chain_rule(x, h, step_);
    const Eigen::Matrix<double, kMiddle, kVariables> half = inner * chain;
    Eigen::Map<Eigen::Matrix<double, kVariables, kVariables, Eigen::RowMajor>> outer(
        hessian.data());
    outer.noalias() = chain.transpose() * half;
    if constexpr (kLength == StepLength::free) add_step_curvature(x, h, sum, multipliers, outer);
  }

 private:
  static constexpr std::size_t kArgumentSize = static_cast<std::size_t>(kArguments);
  static constexpr std::size_t kMiddleSize = static_cast<std::size_t>(kMiddle);
  static constexpr std::size_t kLawRows = static_cast<std::size_t>(Law::kRows);
  using Chain = Eigen::Matrix<double, kMiddle, kVariables>;

  static constexpr std::size_t at(int i) { return static_cast<std::size_t>(i); }
  static double y0(std::span<const double> x, int i) { return x[at(i)]; }
  static double v0(std::span<const double> x, int i) { return x[at(Dof + i)]; }
  static double y1(std::span<const double> x, int i) { return x[at(2 * Dof + i)]; }
  static double v1(std::span<const double> x, int i) { return x[at(3 * Dof + i)]; }

  [[nodiscard]] double length(std::span<const double> x) const {
    if constexpr (kLength == StepLength::free) return step_ * x[at(4 * Dof)];
    return step_;
  }

  [[nodiscard]] double middle_value(std::span<const double> x, double h, int i) const {
    if (i == 3 * Dof) return h;
    const int d = i % Dof;
    if (i < Dof) return 0.5 * (y0(x, d) + y1(x, d)) - 0.125 * h * (v1(x, d) - v0(x, d));
    if (i < 2 * Dof) return 0.5 * (v0(x, d) + v1(x, d));
    return (v1(x, d) - v0(x, d)) / h + shift_.acceleration[at(d)];
  }

  template <typename T>
  [[nodiscard]] std::array<T, kArgumentSize> seeded_middle(std::span<const double> x,
                                                           double h) const {
    std::array<T, kArgumentSize> middle;
    for (int i = 0; i < kArguments; ++i) {
      const double value = middle_value(x, h, i);
      middle[at(i)] = i < kMiddle ? T::variable(value, i) : T(value);
    }
    return middle;
  }

  static Eigen::RowVector<double, kMiddle> gradient_row(const FirstOrder<kMiddleSize>& value) {
    return Eigen::Map<const Eigen::RowVector<double, kMiddle>>(value.gradient.data());
  }

  /// d(middle) / d(local variables)
  static Chain chain_rule(std::span<const double> x, double h, double share) {
    Chain chain = Chain::Zero();
    for (int d = 0; d < Dof; ++d) {
      const int y = d;
      const int v = Dof + d;
      const int u = 2 * Dof + d;
      chain(y, d) = chain(y, 2 * Dof + d) = 0.5;
      chain(y, Dof + d) = 0.125 * h;
      chain(y, 3 * Dof + d) = -0.125 * h;
      chain(v, Dof + d) = chain(v, 3 * Dof + d) = 0.5;
      chain(u, Dof + d) = -1.0 / h;
      chain(u, 3 * Dof + d) = 1.0 / h;
      if constexpr (kLength == StepLength::free) {
        const double change = v1(x, d) - v0(x, d);
        chain(y, 4 * Dof) = -0.125 * share * change;
        chain(u, 4 * Dof) = -share * change / (h * h);
      }
    }
    if constexpr (kLength == StepLength::free) chain(3 * Dof, 4 * Dof) = share;
    return chain;
  }

  static void trapezoid_slopes(std::span<const double> x, double h, double share,
                               std::span<double> jacobian) {
    std::fill_n(jacobian.begin(), Dof * kVariables, 0.0);
    for (int d = 0; d < Dof; ++d) {
      const std::span<double> row = jacobian.subspan(at(d * kVariables), at(kVariables));
      row[at(d)] = -1.0;
      row[at(2 * Dof + d)] = 1.0;
      row[at(Dof + d)] = row[at(3 * Dof + d)] = -0.5 * h;
      if constexpr (kLength == StepLength::free) {
        row[at(4 * Dof)] = -0.5 * share * (v0(x, d) + v1(x, d));
      }
    }
  }

  /// Second derivatives of the mid-point and of the trapezoid that involve h.
  template <typename Sum, typename Outer>
  void add_step_curvature(std::span<const double> x, double h, const Sum& sum,
                          std::span<const double> multipliers, Outer& outer) const {
    const double share = step_;
    for (int d = 0; d < Dof; ++d) {
      const double by_y = sum.gradient[at(d)];
      const double by_u = sum.gradient[at(2 * Dof + d)];
      const double cross = share * (0.125 * by_y + by_u / (h * h));
      const double trapezoid = -0.5 * share * multipliers[at(d)];
      outer(4 * Dof, Dof + d) += cross + trapezoid;
      outer(4 * Dof, 3 * Dof + d) += -cross + trapezoid;
      outer(4 * Dof, 4 * Dof) += 2.0 * share * share * by_u * (v1(x, d) - v0(x, d)) / (h * h * h);
    }
  }

  Law law_;
  std::array<int, static_cast<std::size_t>(kVariables)> variables_;
  double step_;
  StepShift<Dof> shift_;
};

}  // namespace hopscotch::planner
