#include "planner/ipopt_problem.hpp"

#include <IpIpoptApplication.hpp>
#include <IpSolveStatistics.hpp>
#include <IpTNLP.hpp>
#include <algorithm>
#include <cmath>
#include <cstring>

namespace hopscotch::planner {

namespace {

using Ipopt::Index;
using Ipopt::Number;

/// Ipopt takes bounds of this size as none.
constexpr double kIpoptInfinity = 2e19;
/// Keeps objective and rows of comparable size in Ipopt's scaled problem.
constexpr double kObjectiveScale = 0.1;
/// Iterations of the restoration phase before a jump counts as impossible.
constexpr int kRestorationsMax = 10;

void copy_bounds(const Eigen::VectorXd& from, Number* to) {
  for (Eigen::Index i = 0; i < from.size(); ++i) {
    to[i] = std::clamp(from(i), -kIpoptInfinity, kIpoptInfinity);
  }
}

/// Answers Ipopt's questions about the program.
class Problem final : public Ipopt::TNLP {
 public:
  Problem(const NonlinearProgram& program, const DecisionBounds& bounds,
          const Eigen::VectorXd& sizes, const StartPoint& start)
      : program_(program), bounds_(bounds), sizes_(sizes), start_(start) {}

  [[nodiscard]] const Eigen::VectorXd& solution() const { return solution_; }
  [[nodiscard]] double cost() const { return cost_; }

  bool get_nlp_info(Index& n, Index& m, Index& nnz_jac, Index& nnz_hessian,
                    IndexStyleEnum& style) override {
    n = program_.variables();
    m = program_.rows();
    nnz_jac = static_cast<Index>(program_.jacobian_pattern().size());
    nnz_hessian = static_cast<Index>(program_.hessian_pattern().size());
    style = C_STYLE;
    return true;
  }

  bool get_bounds_info(Index, Number* x_lower, Number* x_upper, Index, Number* g_lower,
                       Number* g_upper) override {
    copy_bounds(bounds_.lower, x_lower);
    copy_bounds(bounds_.upper, x_upper);
    copy_bounds(program_.row_lower(), g_lower);
    copy_bounds(program_.row_upper(), g_upper);
    return true;
  }

  bool get_scaling_parameters(Number& objective, bool& use_x, Index n, Number* x_scale, bool& use_g,
                              Index, Number*) override {
    objective = kObjectiveScale;
    use_x = true;
    for (Index i = 0; i < n; ++i) x_scale[i] = 1.0 / sizes_(i);
    use_g = false;  // every row is a share of its limit already
    return true;
  }

  bool get_starting_point(Index n, bool, Number* x, bool, Number*, Number*, Index, bool,
                          Number*) override {
    std::copy_n(start_.x.data(), n, x);
    return true;
  }

  bool eval_f(Index, const Number* x, bool, Number& value) override {
    update_values(x);
    value = value_;
    return std::isfinite(value);
  }
  bool eval_g(Index, const Number* x, bool, Index m, Number* g) override {
    update_values(x);
    std::copy_n(rows_.data(), m, g);
    return true;
  }
  bool eval_grad_f(Index n, const Number* x, bool, Number* gradient) override {
    update_slopes(x);
    std::copy_n(gradient_.data(), n, gradient);
    return true;
  }
  bool eval_jac_g(Index, const Number* x, bool, Index, Index count, Index* row, Index* column,
                  Number* values) override {
    if (values == nullptr) {
      copy_pattern(program_.jacobian_pattern(), row, column);
      return true;
    }
    update_slopes(x);
    std::copy_n(jacobian_.data(), count, values);
    return true;
  }
  bool eval_h(Index, const Number* x, bool, Number factor, Index, const Number* multipliers, bool,
              Index count, Index* row, Index* column, Number* values) override {
    if (values == nullptr) {
      copy_pattern(program_.hessian_pattern(), row, column);
      return true;
    }
    program_.curvature(x, factor, multipliers, hessian_);
    std::copy_n(hessian_.data(), count, values);
    return true;
  }

  /// A long restoration phase means that the jump is not possible; it is also the slowest part of
  /// Ipopt. Counting its iterations bounds the time of a refusal without looking at a clock.
  bool intermediate_callback(Ipopt::AlgorithmMode mode, Index, Number, Number, Number, Number,
                             Number, Number, Number, Number, Index, const Ipopt::IpoptData*,
                             Ipopt::IpoptCalculatedQuantities*) override {
    if (mode == Ipopt::RestorationPhaseMode) ++restorations_;
    return restorations_ <= kRestorationsMax;
  }

  void finalize_solution(Ipopt::SolverReturn, Index n, const Number* x, const Number*,
                         const Number*, Index, const Number*, const Number*, Number cost,
                         const Ipopt::IpoptData*, Ipopt::IpoptCalculatedQuantities*) override {
    solution_ = Eigen::Map<const Eigen::VectorXd>(x, n);
    cost_ = cost;
  }

 private:
  static void copy_pattern(const std::vector<SparseEntry>& pattern, Index* row, Index* column) {
    for (const SparseEntry& entry : pattern) {
      *row++ = entry.row;
      *column++ = entry.column;
    }
  }

  /// Ipopt asks for cost and rows apart, the blocks give both at once.
  [[nodiscard]] bool same(const Eigen::VectorXd& last, const Number* x) const {
    return last.size() == program_.variables() &&
           std::memcmp(last.data(), x, sizeof(Number) * static_cast<std::size_t>(last.size())) == 0;
  }
  void update_values(const Number* x) {
    if (same(values_at_, x)) return;
    value_ = program_.values(x, rows_);
    values_at_ = Eigen::Map<const Eigen::VectorXd>(x, program_.variables());
  }
  void update_slopes(const Number* x) {
    if (same(slopes_at_, x)) return;
    program_.slopes(x, gradient_, jacobian_);
    slopes_at_ = Eigen::Map<const Eigen::VectorXd>(x, program_.variables());
  }

  const NonlinearProgram& program_;
  const DecisionBounds& bounds_;
  const Eigen::VectorXd& sizes_;
  const StartPoint& start_;
  Eigen::VectorXd values_at_;
  Eigen::VectorXd slopes_at_;
  double value_ = 0.0;
  Eigen::VectorXd rows_;
  Eigen::VectorXd gradient_;
  Eigen::VectorXd jacobian_;
  Eigen::VectorXd hessian_;
  Eigen::VectorXd solution_;
  double cost_ = 0.0;
  int restorations_ = 0;
};

void set_options(const SolveOptions& options, Ipopt::IpoptApplication& application) {
  const Ipopt::SmartPtr<Ipopt::OptionsList> list = application.Options();
  list->SetIntegerValue("print_level", 0);
  list->SetStringValue("sb", "yes");
  list->SetIntegerValue("max_iter", options.iterations_max);
  list->SetNumericValue("tol", options.tolerance);
  list->SetNumericValue("constr_viol_tol", options.tolerance);
  list->SetNumericValue("acceptable_tol", 10.0 * options.tolerance);
  list->SetStringValue("mu_strategy", "adaptive");
  list->SetStringValue("nlp_scaling_method", "user-scaling");
  list->SetStringValue("linear_solver", "mumps");
  list->SetIntegerValue("mumps_pivot_order", 0);  // minimum degree: METIS costs more here
}

SolveStatus status_from(Ipopt::ApplicationReturnStatus status) {
  switch (status) {
    case Ipopt::Solve_Succeeded:
    case Ipopt::Solved_To_Acceptable_Level: return SolveStatus::solved;
    case Ipopt::Maximum_Iterations_Exceeded: return SolveStatus::iteration_limit;
    case Ipopt::Infeasible_Problem_Detected:
    case Ipopt::Restoration_Failed:
    case Ipopt::Search_Direction_Becomes_Too_Small:
    case Ipopt::Not_Enough_Degrees_Of_Freedom:
    case Ipopt::User_Requested_Stop: return SolveStatus::infeasible;
    default: return SolveStatus::failed;
  }
}

double largest_violation(const NonlinearProgram& program, const DecisionBounds& bounds,
                         const Eigen::VectorXd& x) {
  Eigen::VectorXd rows;
  program.values(x.data(), rows);
  const double of_rows =
      std::max((program.row_lower() - rows).maxCoeff(), (rows - program.row_upper()).maxCoeff());
  const double of_bounds = std::max((bounds.lower - x).maxCoeff(), (x - bounds.upper).maxCoeff());
  return std::max({0.0, of_rows, of_bounds});
}

}  // namespace

SolveOutcome solve_with_ipopt(const NonlinearProgram& program, const DecisionBounds& bounds,
                              const Eigen::VectorXd& sizes, const StartPoint& start,
                              const SolveOptions& options) {
  const Ipopt::SmartPtr<Problem> problem = new Problem(program, bounds, sizes, start);
  Ipopt::IpoptApplication application(false);
  set_options(options, application);
  SolveOutcome outcome;
  // Without a file name Ipopt would read ipopt.opt of the current folder.
  if (application.Initialize("") != Ipopt::Solve_Succeeded) return outcome;
  outcome.status = status_from(application.OptimizeTNLP(Ipopt::GetRawPtr(problem)));
  if (Ipopt::IsValid(application.Statistics())) {
    outcome.iterations = application.Statistics()->IterationCount();
  }
  if (problem->solution().size() == 0) {
    outcome.status = SolveStatus::failed;
    return outcome;
  }
  outcome.x = problem->solution();
  outcome.cost = problem->cost();
  outcome.violation = largest_violation(program, bounds, outcome.x);
  return outcome;
}

}  // namespace hopscotch::planner
