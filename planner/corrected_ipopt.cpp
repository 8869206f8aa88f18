#include "planner/corrected_ipopt.hpp"

#include "planner/ipopt_problem.hpp"
#include "planner/row_places.hpp"

namespace hopscotch::planner {

namespace {

constexpr int kPassesMax = 12;

NonlinearProgram corrected_program(const PlanarModel& model, const PlanarTask& task,
                                   const ChainProblem& problem, const ChainCorrection& correction) {
  NonlinearProgram program =
      jump_program(model, task, problem.layout().decision(), correction.steps);
  int row = -1;
  const RowPlaces places(problem);
  for (const RowPlace& place : places.list()) {
    ++row;
    if (place.is_equality) continue;
    program.bound_row(row, problem.lower()(place.at), problem.upper()(place.at));
  }
  return program;
}

Eigen::VectorXd slot_values(const ChainProblem& problem, const Eigen::VectorXd& x) {
  Eigen::VectorXd point(x.size() + 1);
  point << x, 0.0;
  Eigen::VectorXd slots(problem.layout().slots());
  Eigen::VectorXd equalities(problem.layout().equalities());
  (void)problem.values(point, slots, equalities);
  return slots;
}

}  // namespace

SolvedMotion solve_corrected_with_ipopt(const PlanarModel& model, const PlanarTask& task,
                                        const DecisionLayout& layout,
                                        const Eigen::VectorXd& start) {
  ChainProblem problem(model, task, layout);
  ChainCorrection correction(problem.layout());
  SolvedMotion best;
  double least = kUnbounded;
  int iterations = 0;
  StartPoint from{start};
  for (int pass = 0; pass < kPassesMax && least > kDefectWanted; ++pass) {
    problem.correct(correction);
    SolvedMotion now;
    now.outcome = solve_with_ipopt(corrected_program(model, task, problem, correction),
                                   decision_bounds(model, task, layout), decision_sizes(layout),
                                   from, {model.config.iterations_max, model.config.tolerance});
    iterations += now.outcome.iterations;
    from.x = now.outcome.x;
    now.motion = motion_from_decision(model, task, layout, now.outcome.x);
    set_correction(correction, now.motion);
    if (pass == 0) best = now;
    if (!is_acceptable(now.outcome)) break;
    const double defect =
        update_correction(model, task, problem.layout(),
                          {now.motion, slot_values(problem, now.outcome.x)}, correction)
            .worst();
    if (defect >= least) continue;
    least = defect;
    best = std::move(now);
  }
  best.outcome.iterations = iterations;
  return best;
}

}  // namespace hopscotch::planner
