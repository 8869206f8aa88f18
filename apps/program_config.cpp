#include "apps/program_config.hpp"

namespace hopscotch::apps {

using core::Range;

RuntimeConfig RuntimeConfig::load(const core::ConfigReader& section) {
  RuntimeConfig config;
  config.perception_latency =
      1e-3 * section.number("perception_latency_ms", Range::closed(0.0, 200.0));
  config.planning_latency =
      1e-3 * section.number("planning_latency_ms", Range::closed(0.0, 5000.0));
  config.mpc_latency = 1e-3 * section.number("mpc_latency_ms", Range::closed(0.0, 20.0));
  config.takeoff_replanning = section.flag("takeoff_replanning");
  config.landing_replanning = section.flag("landing_replanning");
  config.replanning_latency =
      1e-3 * section.number("replanning_latency_ms", Range::closed(0.0, 100.0));
  config.mpc_period = 1e-3 * section.number("mpc_period_ms", Range::closed(1.0, 50.0));
  config.look_time = section.number("look_time_s", Range::closed(0.0, 5.0));
  config.look_frames = section.integer("look_frames", 1, 100);
  config.sight_age_max = section.number("sight_age_max_s", Range::above(0.0, 10.0));
  config.patience = section.number("patience_s", Range::closed(0.0, 30.0));
  config.settle_time = section.number("settle_time_s", Range::closed(0.0, 10.0));
  config.settle_speed = section.number("settle_speed_mps", Range::positive());
  config.time_limit = section.number("time_limit_s", Range::positive());
  section.finish();
  return config;
}

ProgramConfig ProgramConfig::load(const std::filesystem::path& file) {
  const core::ConfigReader whole = core::ConfigReader::from_file(file);
  const core::ConfigReader root = whole.section_if("configuration").value_or(whole);
  ProgramConfig config;
  config.runtime = RuntimeConfig::load(root.section("runtime"));
  config.threads = ThreadsConfig::load(root.section("threads"));
  const core::ConfigReader model_section = root.section("model");
  config.stand_posture = model::StandPosture::load(model_section.section("stand_posture"));
  model_section.finish();
  config.perception = perception::PerceptionConfig::load(root.section("perception"));
  config.footstep = footstep::FootstepConfig::load(root.section("footstep"));
  config.planner = planner::PlannerConfig::load(root.section("planner"));
  config.control =
      control::ControlConfig::load(root.section("control"), config.runtime.mpc_latency);
  root.finish();
  return config;
}

}  // namespace hopscotch::apps
