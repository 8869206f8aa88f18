#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "apps/run_folder.hpp"
#include "apps/run_result.hpp"
#include "core/robot_state.hpp"

/// Why a run went wrong: evidence from its log, in the order in which it happened. The taxonomy and
/// its thresholds are described in docs/explain.md.
namespace hopscotch::apps {

/// What can go wrong first. The spelling of `cause_code` is part of the file formats.
enum class Cause : std::uint8_t {
  none,             ///< All went well.
  push,             ///< Something pushed the robot: its momentum changed without a ground force.
  slip,             ///< A loaded sole slid.
  toe_catch,        ///< A foot touched something on the way.
  terrain_height,   ///< The ground was higher or lower than the plan was told.
  overshoot,        ///< Landed too far.
  undershoot,       ///< Landed too short.
  sideways,         ///< Landed beside the target.
  takeoff_speed,    ///< Left the ground with another velocity than planned.
  saturation,       ///< Motors at their limits for longer than the plan allows for.
  estimator,        ///< The state that the controller believed was wrong.
  contact,          ///< Contact was seen where there was none, or the other way round.
  late_plan,        ///< No plan in time.
  deadline,         ///< The control tick came late.
  sensors,          ///< Stale or impossible readings.
  joint_limit,      ///< A joint left its range or speed.
  tilt,             ///< Leaned over without any of the above.
  no_target,        ///< Nowhere safe to land.
  plan_infeasible,  ///< A target, but no jump to it.
  operator_stop,    ///< A person stopped it.
  unknown,          ///< The log does not tell.
};
[[nodiscard]] std::string_view cause_code(Cause cause);

/// One piece of evidence.
struct Clue {
  Cause cause = Cause::unknown;
  double time = core::kNaN;   ///< Since the start of the run [s].
  int jump = 0;               ///< From 1; 0 before the first.
  double value = core::kNaN;  ///< Measured, in `unit`.
  double limit = core::kNaN;  ///< That it broke, in `unit`.
  std::string unit;
  std::string sentence;  ///< For people, with the numbers.
};

struct Explanation {
  RunResult result;
  Clue first;                  ///< The first cause; `none` when there is nothing to explain.
  std::vector<Clue> findings;  ///< In order of time, the first cause included.
};

/// @throws std::runtime_error, core::ConfigError naming the file that is missing or broken.
[[nodiscard]] Explanation explain_run(const RunFolder& folder);

/// For people, several lines.
[[nodiscard]] std::string to_text(const Explanation& explanation);
/// Schema "hopscotch.explain/1", one object.
[[nodiscard]] std::string to_json(const Explanation& explanation);

}  // namespace hopscotch::apps
