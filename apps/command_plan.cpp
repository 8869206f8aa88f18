#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "apps/commands.hpp"
#include "apps/installation.hpp"
#include "apps/plan_json.hpp"
#include "apps/program_config.hpp"
#include "apps/stopwatch.hpp"
#include "apps/text_file.hpp"
#include "core/config_reader.hpp"
#include "planner/jump_planner.hpp"
#include "planner/step_target.hpp"

namespace hopscotch::apps {

namespace {

struct PlanOptions {
  planner::StepRequest step;
  double friction = core::kNaN;
  std::string robot = "hector";
  std::string model = "variable";
  std::string solver = "chain";
  int repeat = 1;
  bool cold = false;
  bool json = false;
  std::filesystem::path config = config_directory() / "hopscotch.yaml";
  std::filesystem::path out;
};

void say_plan(const core::JumpPlan& plan, const PlanContext& context) {
  std::printf("%.2f m ahead, %+.2f m: %s after %d iterations, %.1f ms (median of %d)\n",
              plan.target.distance, plan.target.height,
              std::string(core::plan_status_name(plan.status)).c_str(), plan.iterations,
              context.solve_ms.p50, context.solves);
  std::printf("takeoff %.2f s, flight %.2f s, landing %.2f s; normal force up to %.0f N\n",
              plan.liftoff_time, plan.touchdown_time - plan.liftoff_time,
              plan.duration - plan.touchdown_time, plan.peaks.normal_force);
  for (std::size_t i = 0; i < plan.certificate.count; ++i) {
    const core::CertificateEntry& entry = plan.certificate.entries[i];
    std::printf("  margin %6.3f  %-28s at %.3f s\n", entry.margin, std::string(entry.name).c_str(),
                entry.time);
  }
}

planner::PlanRequest request_of(const PlanOptions& options, const ProgramConfig& config,
                                const model::RobotParameters& robot) {
  const std::optional<model::StandPose> pose = model::stand_pose(robot, config.stand_posture);
  if (!pose) throw core::ConfigError("model.stand_posture: " + robot.name + " cannot stand so");
  planner::StepRequest step = options.step;
  if (std::isnan(step.edge)) step.edge = planner::default_edge(step.distance, step.height);
  return {.start = planner::standing_state(*pose),
          .target = planner::step_target(step, robot),
          .final_posture = config.stand_posture,
          .guess = options.cold ? planner::StartGuess::kinematic : planner::StartGuess::previous,
          .solver = options.solver == "ipopt" ? planner::Solver::ipopt : planner::Solver::chain};
}

ExitStatus plan(const PlanOptions& options) {
  ProgramConfig config = ProgramConfig::load(options.config);
  if (!std::isnan(options.friction)) config.planner.friction = options.friction;
  const model::RobotParameters robot = model::RobotParameters::load(robot_file(options.robot));
  const planner::PlanRequest request = request_of(options, config, robot);
  planner::JumpPlanner planner(config.planner, robot);
  std::vector<double> solve_ms;
  std::optional<core::Result<core::JumpPlan>> result;
  for (int i = 0; i < options.repeat; ++i) {
    const Stopwatch watch(TimeOf::thread);
    result = planner.plan(request);
    solve_ms.push_back(watch.milliseconds());
  }
  if (!result->has_value()) {
    std::fprintf(stderr, "hopscotch: no plan: %s\n", result->error().text().c_str());
    return ExitStatus::answer_is_no;
  }
  const core::JumpPlan& jump = result->value();
  const PlanContext context{options.model, options.solver, Percentiles::of(solve_ms),
                            options.repeat};
  if (!options.out.empty()) write_file_atomically(options.out, plan_trajectory_json(jump, context));
  if (options.json) {
    std::printf("%s", plan_summary_json(jump, context).c_str());
  } else {
    say_plan(jump, context);
  }
  return ExitStatus::ok;
}

}  // namespace

void add_plan_command(CLI::App& app, Action& action) {
  CLI::App* command =
      app.add_subcommand("plan", "One jump from standing: trajectory, certificate, time");
  command->footer("Example: hopscotch plan --distance 0.40 --height 0.10 --json");
  const auto options = std::make_shared<PlanOptions>();  // shared with the action below
  command->add_option("--distance", options->step.distance, "Ahead, sole to sole [m]")->required();
  command->add_option("--height", options->step.height, "Of the landing place [m]");
  command->add_option("--edge", options->step.edge, "Where the ground changes height [m]");
  command->add_option("--lateral", options->step.lateral, "To the left [m]");
  command->add_option("--yaw", options->step.yaw, "Of the landing soles [rad]");
  command->add_option("--robot", options->robot, "Robot file")->capture_default_str();
  command
      ->add_option("--friction", options->friction, "Of the ground, instead of the configured one")
      ->check(CLI::Range(0.05, 1.2));
  command->add_option("--model", options->model, "Formulation")
      ->check(CLI::IsMember({"variable"}))
      ->capture_default_str();
  command->add_option("--solver", options->solver, "Solver")
      ->check(CLI::IsMember({"chain", "ipopt"}))
      ->capture_default_str();
  command->add_option("--repeat", options->repeat, "Solve so often")->check(CLI::Range(1, 10000));
  command->add_flag("--cold", options->cold, "Each solve from the closed-form first guess");
  command->add_option("--config", options->config, "Tuning")->capture_default_str();
  command->add_option("--out", options->out, "Write the trajectory (JSON)");
  command->add_flag("--json", options->json, "Print one JSON object");
  command->callback([&action, options] { action = [options] { return plan(*options); }; });
}

}  // namespace hopscotch::apps
