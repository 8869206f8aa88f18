#include "planner/program_builder.hpp"

#include <algorithm>

namespace hopscotch::planner {

namespace {

Eigen::VectorXd vector_of(const std::vector<double>& list) {
  return Eigen::Map<const Eigen::VectorXd>(list.data(), static_cast<Eigen::Index>(list.size()));
}

}  // namespace

int ProgramBuilder::add_variable(double guess, const ValueRange& range, double size) {
  guess_.push_back(std::clamp(guess, range.lower, range.upper));
  lower_.push_back(range.lower);
  upper_.push_back(range.upper);
  size_.push_back(size);
  return variables() - 1;
}

void ProgramBuilder::fix(int at, double value) {
  const auto i = static_cast<std::size_t>(at);
  guess_[i] = lower_[i] = upper_[i] = value;
}

SolveOutcome ProgramBuilder::solve(const SolveOptions& options, int& rows) {
  const NonlinearProgram program(variables(), std::move(blocks_));
  blocks_.clear();
  rows = program.rows();
  return solve_with_ipopt(program, {vector_of(lower_), vector_of(upper_)}, vector_of(size_),
                          {vector_of(guess_)}, options);
}

}  // namespace hopscotch::planner
