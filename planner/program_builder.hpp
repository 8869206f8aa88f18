#pragma once

#include <array>
#include <utility>
#include <vector>

#include "planner/block_forms.hpp"
#include "planner/ipopt_problem.hpp"
#include "planner/takeoff_phase.hpp"

namespace hopscotch::planner {

/// Allowed values of a variable.
struct ValueRange {
  double lower = -kUnbounded;
  double upper = kUnbounded;
};

/// Collects variables and laws of a nonlinear program one after the other: for the formulations
/// that the planner is compared with, which need no layout of their own.
class ProgramBuilder {
 public:
  /// @param size Typical, by which the solver divides it.
  /// @return its position.
  int add_variable(double guess, const ValueRange& range, double size = 1.0);
  int add_constant(double value) { return add_variable(value, {value, value}); }
  /// Fixes a variable that is there already.
  void fix(int at, double value);

  template <typename Law, std::size_t N>
  void add(Law law, const std::array<int, N>& variables) {
    blocks_.push_back(
        std::make_unique<KnotBlock<Law, static_cast<int>(N)>>(std::move(law), variables));
  }
  void add(std::unique_ptr<ConstraintBlock> block) { blocks_.push_back(std::move(block)); }

  [[nodiscard]] int variables() const { return static_cast<int>(guess_.size()); }
  /// Solves with Ipopt and forgets the blocks. @param[out] rows how many there were.
  [[nodiscard]] SolveOutcome solve(const SolveOptions& options, int& rows);

 private:
  std::vector<double> guess_;
  std::vector<double> lower_;
  std::vector<double> upper_;
  std::vector<double> size_;
  BlockList blocks_;
};

/// Variables one after the other.
template <std::size_t N>
[[nodiscard]] std::array<int, N> consecutive(int first) {
  std::array<int, N> at{};
  for (std::size_t i = 0; i < N; ++i) at[i] = first + static_cast<int>(i);
  return at;
}
template <std::size_t... N>
[[nodiscard]] std::array<int, (N + ...)> joined(const std::array<int, N>&... parts) {
  std::array<int, (N + ...)> all{};
  auto next = all.begin();
  ((next = std::copy(parts.begin(), parts.end(), next)), ...);
  return all;
}

}  // namespace hopscotch::planner
