#pragma once

#include <cstdint>
#include <map>
#include <memory>

#include "core/jump_plan.hpp"
#include "core/landing_target.hpp"
#include "core/result.hpp"
#include "core/robot_state.hpp"
#include "model/robot_parameters.hpp"
#include "model/stand_posture.hpp"
#include "planner/known_jump.hpp"
#include "planner/planner_config.hpp"

namespace hopscotch::planner {

/// What is to be planned anew: a jump from one of its takeoff knots on.
struct RestRequest {
  std::uint64_t id = 0;                    ///< Of the jump's plan.
  std::shared_ptr<const KnownJump> whole;  ///< Its solution, from the start on; not null.
  int steps_done = 0;                      ///< Takeoff steps before the knot.
  core::RobotState state;                  ///< As it probably will be at the knot.
  core::LandingTarget target;              ///< Of the jump.
  model::StandPosture final_posture;       ///< At rest, at the target.
};

/// Planner settings for what is left of a jump after so many takeoff steps: the steps that are left
/// keep their lengths and their parts of the cost, so that the rest of a best jump is itself best.
/// @pre 0 <= steps_done <= steps.takeoff - 2
[[nodiscard]] PlannerConfig config_of_rest(PlannerConfig config, int steps_done);

/// The solution without its first takeoff steps: where the solve of the rest starts.
/// @param steps Of `jump`. @pre 0 <= steps_done <= steps.takeoff - 2
[[nodiscard]] KnownJump rest_of(const KnownJump& jump, const StepCounts& steps, int steps_done);

/// Plans the rest of a jump while its takeoff is under way, from where the robot really is, to the
/// same target: the same program with fewer steps, started from the solution in hand, certified
/// like every plan (docs/decisions/0160). Deterministic: stops on iterations. Not for the control
/// tick. One instance per thread.
class Replanner {
 public:
  Replanner(const PlannerConfig& config, const model::RobotParameters& robot);
  ~Replanner();
  Replanner(const Replanner&) = delete;
  Replanner& operator=(const Replanner&) = delete;

  /// Takeoff steps that must be left: of a shorter rest nothing can be changed.
  static constexpr int kStepsLeftMin = 3;

  /// @return the rest of the plan, its clock starting at the knot; or why the plan in hand has to
  ///         do: target_malformed (fewer steps left than `kStepsLeftMin`, or as JumpPlanner::plan),
  ///         out_of_reach (a jump to the side or with a turn), plan_infeasible,
  ///         certificate_refused.
  core::Result<core::JumpPlan> replan(const RestRequest& request);

  /// Of the last solve.
  [[nodiscard]] int iterations() const { return iterations_; }

 private:
  struct Rest;
  [[nodiscard]] Rest& rest_after(int steps_done);
  /// The solution in hand from takeoff step `steps_done` on.
  [[nodiscard]] KnownJump in_hand(const RestRequest& request);

  PlannerConfig config_;
  model::RobotParameters robot_;
  std::map<int, std::unique_ptr<Rest>> rests_;  ///< By takeoff steps done; made when needed.
  std::uint64_t id_ = 0;                        ///< Of the jump that `last_` is the rest of.
  std::shared_ptr<const KnownJump> last_;
  int last_begin_ = 0;  ///< Takeoff steps before `last_`.
  int iterations_ = 0;
};

}  // namespace hopscotch::planner
