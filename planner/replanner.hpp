#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>

#include "core/jump_plan.hpp"
#include "core/landing_target.hpp"
#include "core/result.hpp"
#include "core/robot_state.hpp"
#include "model/robot_parameters.hpp"
#include "model/stand_posture.hpp"
#include "planner/known_jump.hpp"
#include "planner/planner_config.hpp"

namespace hopscotch::planner {

/// What is to be planned anew: a jump from one of its takeoff or landing knots on.
struct RestRequest {
  std::uint64_t id = 0;                    ///< Of the jump's plan.
  std::shared_ptr<const KnownJump> whole;  ///< Its solution, from the start on; not null.
  int steps_done = 0;                      ///< Steps of all phases before the knot.
  core::RobotState state;                  ///< As it probably will be at the knot.
  core::LandingTarget target;              ///< Of the jump.
  model::StandPosture final_posture;       ///< At rest, at the target.
};

/// Steps that are left of a jump after so many: of its takeoff some with all that follows, or of
/// its landing some alone. Nothing in flight, where there is nothing to choose but postures, nor
/// where fewer than `kRestStepsMin` of the phase are left, of which nothing can be changed.
inline constexpr int kRestStepsMin = 3;
[[nodiscard]] std::optional<StepCounts> rest_steps(const StepCounts& whole, int steps_done);

/// Landing steps of a solved jump that begin before a moment since touchdown [s], by its own clock.
/// @param config That it was solved with.
[[nodiscard]] int landing_steps_begun(const PlannerConfig& config, const KnownJump& jump,
                                      double since_touchdown);

/// Planner settings for what is left of a jump: the steps that are left keep their lengths (of the
/// landing, their shares of dt^l) and their parts of the cost, so that the rest of a best jump is
/// itself best.
/// @pre `rest` is from rest_steps(config.steps, ...).
[[nodiscard]] PlannerConfig config_of_rest(PlannerConfig config, const StepCounts& rest);

/// The solution without the steps that are done: where the solve of the rest starts.
/// @param config That `jump` was solved with. @pre `rest` is from rest_steps(config.steps, ...).
[[nodiscard]] KnownJump rest_of(const KnownJump& jump, const PlannerConfig& config,
                                const StepCounts& rest);

/// Plans the rest of a jump while it pushes off or lands, from where the robot really is, to the
/// same target: the same program with fewer steps, started from the solution in hand, certified
/// like every plan (docs/decisions/0160). Deterministic: stops on iterations. Not for the control
/// tick. One instance per thread.
class Replanner {
 public:
  Replanner(const PlannerConfig& config, const model::RobotParameters& robot);
  ~Replanner();
  Replanner(const Replanner&) = delete;
  Replanner& operator=(const Replanner&) = delete;

  /// @return the rest of the plan, its clock starting at the knot; or why the plan in hand has to
  ///         do: target_malformed (no such rest, or as JumpPlanner::plan), out_of_reach (a jump to
  ///         the side or with a turn), plan_infeasible, certificate_refused.
  core::Result<core::JumpPlan> replan(const RestRequest& request);

  /// Of the last solve.
  [[nodiscard]] int iterations() const { return iterations_; }

 private:
  struct Rest;
  [[nodiscard]] Rest& rest_after(int steps_done, const StepCounts& steps);
  /// The solution in hand without the steps that are done.
  [[nodiscard]] KnownJump in_hand(const RestRequest& request, const StepCounts& rest);

  PlannerConfig config_;
  model::RobotParameters robot_;
  std::map<int, std::unique_ptr<Rest>> rests_;  ///< By steps done; made when needed.
  std::uint64_t id_ = 0;                        ///< Of the jump that `last_` is the rest of.
  std::shared_ptr<const KnownJump> last_;
  int last_begin_ = 0;  ///< Steps before `last_`.
  int iterations_ = 0;
};

}  // namespace hopscotch::planner
