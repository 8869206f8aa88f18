#pragma once

#include <Eigen/Core>
#include <vector>

#include "planner/chain_problem.hpp"
#include "planner/jump_program.hpp"

namespace hopscotch::planner {

/// Where a row of `jump_program` lives in the arrays of the chain.
struct RowPlace {
  bool is_equality = false;
  int at = 0;
};

/// The rows of the blocks in their order; those without bounds are not part of the program.
class RowPlaces {
 public:
  explicit RowPlaces(const ChainProblem& problem);

  [[nodiscard]] const std::vector<RowPlace>& list() const { return list_; }

  /// Of the program's rows, from those of the chain.
  [[nodiscard]] Eigen::VectorXd gather(const Eigen::VectorXd& slots,
                                       const Eigen::VectorXd& equalities) const;

 private:
  void add_equalities(int first, int count);
  void add_slots(const ChainProblem& problem, int first, int count);

  std::vector<RowPlace> list_;
};

}  // namespace hopscotch::planner
