#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>

#include "core/landing_target.hpp"
#include "core/one_step_terrain.hpp"
#include "core/operator_command.hpp"
#include "core/robot_state.hpp"
#include "core/terrain_map.hpp"
#include "footstep/footstep_config.hpp"
#include "model/robot_parameters.hpp"

namespace hopscotch::footstep {

/// What is known of the ground.
struct SeenGround {
  const core::TerrainMap& map;
  const core::OneStepTerrain& terrain;         ///< Cut from the map for the present stance.
  std::span<const Eigen::Vector3f> hanging{};  ///< Bottoms of what hangs over it, in W [m].
};

/// Where the robot is to go.
struct LandingTask {
  double goal_x = core::kNaN;  ///< Both heels beyond it ends the run [m]; NaN: no goal.
  double goal_heading = 0.0;   ///< Direction in W along which the goal is measured [rad].
  core::TargetSource source = core::TargetSource::perception;  ///< Stated in the target.
  std::optional<core::TargetOverride> target{};  ///< A place asked for; judged by the same rules.
  double height_doubt = 0.0;  ///< The ground ahead may be so much higher than the map says [m].
};

/// Chooses where the next jump lands: safe to stand on, within reach, and a place to go on from.
/// Pure: the answer depends on the arguments only. About 0.5 ms; allocates.
class LandingSelector {
 public:
  LandingSelector(const FootstepConfig& config, const model::RobotParameters& robot);

  /// @param state  Both soles on the ground; only its soles are used.
  /// @return a target or a refusal; ranked candidates, best first, and rejected ones either way.
  ///         Numbers that are not finite give the refusal target_malformed (override) or
  ///         terrain_unseen (map, state).
  [[nodiscard]] core::TargetChoice choose(const SeenGround& ground, const core::RobotState& state,
                                          const LandingTask& task) const;

 private:
  FootstepConfig config_;
  model::RobotParameters robot_;
};

}  // namespace hopscotch::footstep
