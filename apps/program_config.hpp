#pragma once

#include <filesystem>

#include "apps/real_time.hpp"
#include "control/control_config.hpp"
#include "core/config_reader.hpp"
#include "footstep/footstep_config.hpp"
#include "model/stand_posture.hpp"
#include "perception/perception_config.hpp"
#include "planner/planner_config.hpp"

namespace hopscotch::apps {

/// Rates and declared latencies: section `runtime`. A result can be used that long after its input.
struct RuntimeConfig {
  double perception_latency = 0.0;  ///< Depth frame delivered to map updated [s].
  double planning_latency = 0.0;    ///< Target and state to plan [s].
  double mpc_latency = 0.0;         ///< State to wrenches [s].
  bool takeoff_replanning = false;  ///< Takeoffs are planned anew while they are under way.
  bool landing_replanning = false;  ///< The same of landings.
  double replanning_latency = 0.0;  ///< State to the rest of a plan [s].
  double mpc_period = 0.0;          ///< [s]
  double look_time = 0.0;           ///< After touchdown, before the next target is chosen [s].
  double sight_age_max = 0.0;       ///< Without a usable depth frame for so long: no target [s].
  int look_frames = 0;              ///< Depth frames that must have come in since then.
  double patience = 0.0;            ///< Looking without a safe target before giving up [s].
  double settle_time = 0.0;         ///< Standing still for so long counts as rest [s].
  double settle_speed = 0.0;        ///< Trunk slower than this is still [m/s].
  double time_limit = 0.0;          ///< Of a run, simulated [s].

  static RuntimeConfig load(const core::ConfigReader& section);
};

/// `config/hopscotch.yaml`, whole, or the same out of the `config.yaml` of a run folder.
struct ProgramConfig {
  RuntimeConfig runtime;
  ThreadsConfig threads;
  model::StandPosture stand_posture;
  perception::PerceptionConfig perception;
  footstep::FootstepConfig footstep;
  planner::PlannerConfig planner;
  control::ControlConfig control;

  /// @throws core::ConfigError naming file, line, key, value and rule.
  static ProgramConfig load(const std::filesystem::path& file);
};

}  // namespace hopscotch::apps
