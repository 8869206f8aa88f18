#pragma once

#include <string>
#include <vector>

#include "core/one_step_terrain.hpp"
#include "core/reason.hpp"
#include "footstep/foothold_score.hpp"
#include "footstep/footstep_config.hpp"
#include "footstep/reachability.hpp"

namespace hopscotch::footstep {

/// A foothold and whether the next jump can lead there.
struct JudgedFoothold {
  Foothold foothold;
  core::Reason why = core::Reason::none;  ///< Of the foothold itself, or else of the jump to it.
};

/// Says in one sentence with numbers what keeps the robot from going on: the first obstacle ahead,
/// not the many places that were looked at.
[[nodiscard]] core::Refusal explain_refusal(const FootstepConfig& config,
                                            const core::OneStepTerrain& terrain,
                                            const std::vector<JudgedFoothold>& judged);

/// The refusal of one particular place that was asked for.
/// @param leap  The jump there.
[[nodiscard]] core::Refusal explain_place(const FootstepConfig& config,
                                          const JudgedFoothold& judged, const Leap& leap);

/// A length [m] in centimetres, as people speak of steps and gaps, e.g. "35.0 cm".
[[nodiscard]] std::string in_cm(double length);

}  // namespace hopscotch::footstep
