#pragma once

#include <cstdint>
#include <memory>
#include <string_view>

#include "core/jump_plan.hpp"
#include "core/landing_target.hpp"
#include "core/result.hpp"
#include "core/robot_state.hpp"
#include "model/robot_parameters.hpp"
#include "model/stand_posture.hpp"
#include "planner/formulation.hpp"
#include "planner/planner_config.hpp"

namespace hopscotch::planner {

class JumpLibrary;
struct KnownJump;

/// Where the solver starts from.
enum class StartGuess : std::uint8_t {
  kinematic,  ///< Closed form, from the request alone.
  library,    ///< The most similar jump of the library where there is one, else kinematic.
  previous,   ///< The planner's last solved jump where there is one, else library.
};

/// How a plan was come by: each rung is tried when the one before gives no certified plan, but a
/// neighbour that was asked for as start guess comes first. Below the last one there is no plan,
/// and the robot stands.
enum class PlanRung : std::uint8_t {
  solved,     ///< From the closed-form guess, or from the last jump.
  neighbour,  ///< Solved from a jump of the library close by.
  library,    ///< A jump of the library as it is, to its own distance; certified for this ground.
};
[[nodiscard]] std::string_view plan_rung_name(PlanRung rung);

/// Who solves the nonlinear program.
enum class Solver : std::uint8_t {
  chain,  ///< Own interior point on the chain of steps: fast, on line.
  ipopt,  ///< Ipopt with MUMPS on the same problem: the reference.
};

struct PlanRequest {
  core::RobotState start;      ///< Feet flat on the ground at the origin of the target's frame S.
  core::LandingTarget target;  ///< Where to, and the terrain in between.
  model::StandPosture final_posture;  ///< At rest, at the target.
  std::uint64_t id = 0;
  /// The first two give the same plan for the same request, whatever was planned before.
  StartGuess guess = StartGuess::library;
  Solver solver = Solver::chain;
  /// Others than the first are for comparison: straight jumps only, always cold and by Ipopt; their
  /// certificate says what exact dynamics make of the plan, and refuses nothing.
  Formulation formulation = Formulation::variable;
};

/// Plans one jump: takeoff, flight and landing as one nonlinear program over the exact sagittal
/// dynamics (eqs. (2)-(12) with the readings of docs/decisions), solved by an interior-point
/// method, certified against the physical limits on a 1 ms grid and lifted to 3-D. Deterministic:
/// stops on iterations, not on time. Not for the control tick (milliseconds, allocates). One
/// instance per thread.
class JumpPlanner {
 public:
  /// @param library For jumps that are hard to solve; shared, since the planners of a program use
  ///                the same one, each on its own thread. None: there are no rungs but the first.
  /// @throws std::invalid_argument if the configured steps do not fit into a JumpPlan, or are not
  ///         those of the library.
  JumpPlanner(const PlannerConfig& config, const model::RobotParameters& robot,
              std::shared_ptr<const JumpLibrary> library = nullptr);
  ~JumpPlanner();
  JumpPlanner(JumpPlanner&&) noexcept;
  JumpPlanner& operator=(JumpPlanner&&) noexcept;

  /// @return a plan that ends at rest, or why there is none: target_malformed (not finite, beside
  ///         the jump line, terrain unknown on the way), out_of_reach (final posture impossible),
  ///         bad_sensor_value (start not finite), plan_infeasible (with iterations and violation),
  ///         certificate_refused (with the binding limit): of the first rung. `iterations` counts
  ///         the solver's, of all rungs. A plan by rung `library` lands up to 3 cm before or behind
  ///         the target asked for; its own target says where.
  core::Result<core::JumpPlan> plan(const PlanRequest& request);

  /// The limit that stood in the way of the last refused request, in the words of the certificate;
  /// empty if that was malformed, or after a solve by Ipopt that found no motion.
  [[nodiscard]] std::string_view obstacle() const;
  /// Iterations of the last solve.
  [[nodiscard]] int iterations() const;
  /// Of the last plan.
  [[nodiscard]] PlanRung rung() const;
  /// Objective of the last jump that was solved and certified.
  [[nodiscard]] double cost() const;
  /// The last jump that was solved by the chain solver and certified; null before the first.
  [[nodiscard]] const KnownJump* last() const;

 private:
  struct Memory;
  std::unique_ptr<Memory> memory_;
};

}  // namespace hopscotch::planner
