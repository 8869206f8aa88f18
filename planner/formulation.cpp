#include "planner/formulation.hpp"

#include "core/check.hpp"

namespace hopscotch::planner {

namespace {

/// The comparisons converge slower than the planner's own formulation.
constexpr int kIterationsMax = 400;

}  // namespace

std::string_view formulation_name(Formulation formulation) {
  switch (formulation) {
    case Formulation::variable: return "variable";
    case Formulation::paper: return "paper";
    case Formulation::full: return "full";
    case Formulation::kinodynamic: return "kinodynamic";
    case Formulation::single_body: return "srbd";
  }
  return "";
}

std::optional<Formulation> formulation_from(std::string_view name) {
  for (const Formulation each : {Formulation::variable, Formulation::paper, Formulation::full,
                                 Formulation::kinodynamic, Formulation::single_body}) {
    if (name == formulation_name(each)) return each;
  }
  return std::nullopt;
}

FormulatedJump solve_formulation(Formulation formulation, const PlanarModel& model,
                                 const PlanarTask& task) {
  HOPSCOTCH_CHECK(formulation != Formulation::variable);
  const SolveOptions options{kIterationsMax, model.config.tolerance};
  switch (formulation) {
    case Formulation::paper: return solve_paper(model, task, options);
    case Formulation::full: return solve_full(model, task, options);
    case Formulation::kinodynamic: return solve_kinodynamic(model, task, options);
    default: return solve_single_body(model, task, options);
  }
}

}  // namespace hopscotch::planner
