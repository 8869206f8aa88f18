#pragma once

#include <limits>
#include <span>
#include <vector>

#include "core/reason.hpp"
#include "footstep/foothold_score.hpp"
#include "footstep/footstep_config.hpp"
#include "footstep/reachability.hpp"
#include "footstep/terrain_profile.hpp"

namespace hopscotch::footstep {

/// Something that hangs over the jump line, in S.
struct Overhead {
  double x = 0.0;       ///< [m]
  double bottom = 0.0;  ///< [m]
};

/// What the terrain and the task ask of each jump along the line.
struct StepRules {
  const FootstepConfig& config;
  const BoundedProfile& profile;  ///< With the ground underfoot where the soles are.
  const BoundedProfile& mapped;   ///< As the map has it.
  std::span<const Overhead> overhead{};
  double height_doubt = 0.0;                                ///< Of what is flown over [m].
  double half_length = 0.0;                                 ///< Of a sole [m].
  double goal_x = std::numeric_limits<double>::infinity();  ///< Mid-point of the soles, in S [m].
};

/// Where a jump starts.
struct Takeoff {
  double x = 0.0;       ///< Mid-point of the soles in S [m].
  double height = 0.0;  ///< In S [m].
  double edge = 0.0;    ///< The tread ends here, in S [m]; infinity when it goes on.
};

[[nodiscard]] Takeoff takeoff_from(const Foothold& foothold, double half_length);

/// One jump along the line.
[[nodiscard]] Leap leap_to(const Takeoff& from, const Foothold& to);

/// Whether one jump along the line can be made: `none`, or the reason of the reach table, or
/// terrain_unseen when it leads over unbounded ground, step_too_high over a hurdle, or
/// no_safe_target below something that hangs too low.
[[nodiscard]] core::Reason step_verdict(const StepRules& rules, const Takeoff& from,
                                        const Foothold& to);

/// Cost of one possible jump: off the nominal distance, close to edges, beyond the goal.
[[nodiscard]] double step_cost(const StepRules& rules, const Takeoff& from, const Foothold& to);

/// Cost of the best known way on from each foothold, `look_ahead - 1` jumps deep: zero at the goal,
/// the dead-end cost where no way on is known or likely. Footholds that are not safe get infinity.
/// @param footholds  Ascending in x.
[[nodiscard]] std::vector<double> continuation_costs(const StepRules& rules,
                                                     const std::vector<Foothold>& footholds);

}  // namespace hopscotch::footstep
