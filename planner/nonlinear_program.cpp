#include "planner/nonlinear_program.hpp"

#include <algorithm>

namespace hopscotch::planner {

namespace {

/// Calls visit(local position, entry) for each structural non-zero of the block's Jacobian.
template <typename Visit>
void visit_jacobian(const ConstraintBlock& block, const std::vector<int>& rows, Visit visit) {
  const std::span<const int> at = block.variables();
  const int n = static_cast<int>(at.size());
  for (int r = 0; r < block.rows(); ++r) {
    const int row = rows[static_cast<std::size_t>(r)];
    if (row < 0) continue;
    for (int c = 0; c < n; ++c) {
      const int column = at[static_cast<std::size_t>(c)];
      if (column != kNoVariable && block.depends(r, c)) visit(r * n + c, SparseEntry{row, column});
    }
  }
}

/// The same for the lower triangle of the Hessian.
template <typename Visit>
void visit_hessian(const ConstraintBlock& block, Visit visit) {
  const std::span<const int> at = block.variables();
  const int n = static_cast<int>(at.size());
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j <= i; ++j) {
      const int a = at[static_cast<std::size_t>(i)];
      const int b = at[static_cast<std::size_t>(j)];
      if (a == kNoVariable || b == kNoVariable || !block.curved(i, j)) continue;
      visit(i * n + j, SparseEntry{std::max(a, b), std::min(a, b)});
    }
  }
}

void sort_unique(std::vector<SparseEntry>& entries) {
  std::sort(entries.begin(), entries.end());
  entries.erase(std::unique(entries.begin(), entries.end()), entries.end());
}

int find(const std::vector<SparseEntry>& entries, const SparseEntry& entry) {
  return static_cast<int>(std::lower_bound(entries.begin(), entries.end(), entry) -
                          entries.begin());
}

}  // namespace

NonlinearProgram::NonlinearProgram(int variables,
                                   std::vector<std::unique_ptr<ConstraintBlock>> blocks)
    : variables_(variables) {
  blocks_.reserve(blocks.size());
  for (std::unique_ptr<ConstraintBlock>& block : blocks) {
    blocks_.push_back({std::move(block), {}, {}, {}});
    place_rows(blocks_.back());
  }
  collect_patterns();
  for (Placed& placed : blocks_) link(placed);
}

void NonlinearProgram::place_rows(Placed& placed) {
  const std::size_t count = static_cast<std::size_t>(placed.block->rows());
  std::vector<double> lower(count);
  std::vector<double> upper(count);
  placed.block->bounds(lower, upper);
  std::vector<double> kept_lower;
  std::vector<double> kept_upper;
  const Eigen::Index first = lower_.size();
  for (std::size_t r = 0; r < count; ++r) {
    if (lower[r] == -kUnbounded && upper[r] == kUnbounded) {
      placed.rows.push_back(-1);
      continue;
    }
    placed.rows.push_back(static_cast<int>(first) + static_cast<int>(kept_lower.size()));
    kept_lower.push_back(lower[r]);
    kept_upper.push_back(upper[r]);
  }
  const Eigen::Index kept = static_cast<Eigen::Index>(kept_lower.size());
  lower_.conservativeResize(first + kept);
  upper_.conservativeResize(first + kept);
  lower_.tail(kept) = Eigen::Map<const Eigen::VectorXd>(kept_lower.data(), kept);
  upper_.tail(kept) = Eigen::Map<const Eigen::VectorXd>(kept_upper.data(), kept);
}

void NonlinearProgram::collect_patterns() {
  for (const Placed& placed : blocks_) {
    visit_jacobian(*placed.block, placed.rows,
                   [&](int, const SparseEntry& entry) { jacobian_.push_back(entry); });
    visit_hessian(*placed.block, [&](int, const SparseEntry& entry) { hessian_.push_back(entry); });
  }
  sort_unique(jacobian_);
  sort_unique(hessian_);
}

void NonlinearProgram::link(Placed& placed) const {
  visit_jacobian(*placed.block, placed.rows, [&](int local, const SparseEntry& entry) {
    placed.jacobian.push_back({local, find(jacobian_, entry)});
  });
  visit_hessian(*placed.block, [&](int local, const SparseEntry& entry) {
    placed.hessian.push_back({local, find(hessian_, entry)});
  });
}

void NonlinearProgram::gather(const ConstraintBlock& block, const double* x,
                              std::vector<double>& local) {
  local.clear();
  for (const int at : block.variables()) local.push_back(at == kNoVariable ? 0.0 : x[at]);
}

double NonlinearProgram::values(const double* x, Eigen::VectorXd& rows) const {
  rows.resize(lower_.size());
  double cost = 0.0;
  std::vector<double> local;
  std::vector<double> block_rows;
  for (const Placed& placed : blocks_) {
    gather(*placed.block, x, local);
    block_rows.assign(placed.rows.size(), 0.0);
    cost += placed.block->values(local, block_rows);
    for (std::size_t r = 0; r < placed.rows.size(); ++r) {
      if (placed.rows[r] >= 0) rows(placed.rows[r]) = block_rows[r];
    }
  }
  return cost;
}

void NonlinearProgram::slopes(const double* x, Eigen::VectorXd& cost_gradient,
                              Eigen::VectorXd& jacobian) const {
  cost_gradient.setZero(variables_);
  jacobian.setZero(static_cast<Eigen::Index>(jacobian_.size()));
  std::vector<double> local;
  std::vector<double> gradient;
  std::vector<double> dense;
  for (const Placed& placed : blocks_) {
    gather(*placed.block, x, local);
    gradient.assign(local.size(), 0.0);
    dense.assign(local.size() * placed.rows.size(), 0.0);
    placed.block->slopes(local, gradient, dense);
    const std::span<const int> at = placed.block->variables();
    for (std::size_t i = 0; i < at.size(); ++i) {
      if (at[i] != kNoVariable) cost_gradient(at[i]) += gradient[i];
    }
    for (const Link& each : placed.jacobian) {
      jacobian(each.global) += dense[static_cast<std::size_t>(each.local)];
    }
  }
}

void NonlinearProgram::curvature(const double* x, double cost_factor, const double* multipliers,
                                 Eigen::VectorXd& hessian) const {
  hessian.setZero(static_cast<Eigen::Index>(hessian_.size()));
  std::vector<double> local;
  std::vector<double> weights;
  std::vector<double> dense;
  for (const Placed& placed : blocks_) {
    if (placed.hessian.empty()) continue;
    gather(*placed.block, x, local);
    weights.clear();
    for (const int row : placed.rows) weights.push_back(row < 0 ? 0.0 : multipliers[row]);
    dense.assign(local.size() * local.size(), 0.0);
    placed.block->curvature(local, cost_factor, weights, dense);
    for (const Link& each : placed.hessian) {
      hessian(each.global) += dense[static_cast<std::size_t>(each.local)];
    }
  }
}

}  // namespace hopscotch::planner
