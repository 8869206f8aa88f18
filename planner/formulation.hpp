#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "planner/ipopt_problem.hpp"
#include "planner/planar_jump.hpp"

namespace hopscotch::planner {

/// Which dynamics a plan is made with. All but the first are there to be compared with it; Ipopt
/// solves them.
enum class Formulation : std::uint8_t {
  variable,     ///< The planner's own: exact chain on the ground, exact momentum in the air.
  paper,        ///< The source's variable model, to the letter.
  full,         ///< Floating-base chain in fine steps throughout.
  kinodynamic,  ///< Spatial rigid body with the kinematics of both legs.
  single_body,  ///< One rigid body with a given schedule: a quadratic program.
};
[[nodiscard]] std::string_view formulation_name(Formulation formulation);
/// @return empty for any other text.
[[nodiscard]] std::optional<Formulation> formulation_from(std::string_view name);

/// What a formulation makes of a task.
struct FormulatedJump {
  SolveOutcome outcome;
  int variables = 0;
  int rows = 0;
  PlanarMotion motion;  ///< With what the formulation promises of each step.
};

/// The source's eqs. (2)-(12) as printed, where they say something: explicit Euler, virtual ground
/// force, trunk as a falling body with the other links' weight, landing by a single rigid body.
[[nodiscard]] FormulatedJump solve_paper(const PlanarModel& model, const PlanarTask& task,
                                         const SolveOptions& options);
/// All phases by the floating-base chain of four links, in 130 steps.
[[nodiscard]] FormulatedJump solve_full(const PlanarModel& model, const PlanarTask& task,
                                        const SolveOptions& options);
/// A spatial rigid body, forces and moments of both feet, and joint angles of both legs.
[[nodiscard]] FormulatedJump solve_kinodynamic(const PlanarModel& model, const PlanarTask& task,
                                               const SolveOptions& options);
/// One planar rigid body, with times and lever arms from the closed-form guess.
[[nodiscard]] FormulatedJump solve_single_body(const PlanarModel& model, const PlanarTask& task,
                                               const SolveOptions& options);

/// Any but the first.
[[nodiscard]] FormulatedJump solve_formulation(Formulation formulation, const PlanarModel& model,
                                               const PlanarTask& task);

}  // namespace hopscotch::planner
