#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "apps/commands.hpp"
#include "apps/flight_trial.hpp"
#include "apps/html.hpp"
#include "apps/installation.hpp"
#include "apps/option_check.hpp"
#include "apps/plan_json.hpp"
#include "apps/program_config.hpp"
#include "apps/shipped_jumps.hpp"
#include "apps/stopwatch.hpp"
#include "apps/text_file.hpp"
#include "apps/video.hpp"
#include "core/config_reader.hpp"
#include "planner/certified_plan.hpp"
#include "planner/jump_planner.hpp"
#include "planner/nearest_target.hpp"
#include "planner/step_target.hpp"

namespace hopscotch::apps {

namespace {

struct PlanOptions {
  planner::StepRequest step;
  double friction = core::kNaN;
  std::string robot = "hector";
  std::string model = "variable";
  std::string solver;  ///< Empty: chain, or ipopt where only that solves the model.
  int repeat = 1;
  bool cold = false;
  bool json = false;
  bool fly = false;
  std::filesystem::path config = config_directory() / "hopscotch.yaml";
  std::filesystem::path out;
  std::filesystem::path video;
};

void say_plan(const core::JumpPlan& plan, const PlanContext& context) {
  std::printf("%.2f m ahead, %+.2f m: %s after %d iterations, %.1f ms (median of %d)\n",
              plan.target.distance, plan.target.height,
              std::string(core::plan_status_name(plan.status)).c_str(), plan.iterations,
              context.solve_ms.p50, context.solves);
  if (context.rung != planner::plan_rung_name(planner::PlanRung::solved)) {
    std::printf("by the rung `%s` of the ladder\n", std::string(context.rung).c_str());
  }
  std::printf("takeoff %.2f s, flight %.2f s, landing %.2f s; normal force up to %.0f N\n",
              plan.liftoff_time, plan.touchdown_time - plan.liftoff_time,
              plan.duration - plan.touchdown_time, plan.peaks.normal_force);
  for (std::size_t i = 0; i < plan.certificate.count; ++i) {
    const core::CertificateEntry& entry = plan.certificate.entries[i];
    std::printf("  margin %6.3f  %-28s at %.3f s\n", entry.margin, std::string(entry.name).c_str(),
                entry.time);
  }
  if (const auto breach = planner::certificate_breach(plan.certificate)) {
    std::printf("the certificate does not hold: %s. The robot cannot fly this plan\n",
                breach->sentence.c_str());
  }
}

planner::PlanRequest request_of(const PlanOptions& options, const ProgramConfig& config,
                                const model::RobotParameters& robot) {
  const std::optional<model::StandPose> pose = model::stand_pose(robot, config.stand_posture);
  if (!pose) throw core::ConfigError("model.stand_posture: " + robot.name + " cannot stand so");
  return {.start = planner::standing_state(*pose),
          .target = planner::step_target(options.step, robot),
          .final_posture = config.stand_posture,
          .guess = options.cold ? planner::StartGuess::library : planner::StartGuess::previous,
          .solver = options.solver == "ipopt" ? planner::Solver::ipopt : planner::Solver::chain,
          .formulation = *planner::formulation_from(options.model)};
}

void say_flown(const FlownJump& flown) {
  const JumpResult& jump = flown.jump;
  std::printf("flown: %s", std::string(jump_outcome_name(jump.outcome)).c_str());
  if (!jump.reason.empty()) std::printf(" (%s)", jump.reason.c_str());
  if (jump.outcome != JumpOutcome::fell) {
    std::printf(", %.3f m ahead, %+.3f m aside, turned %+.3f rad; %.1f cm from the target",
                jump.landing.distance, flown.lateral, flown.yaw, 100.0 * flown.landing_error);
  }
  std::printf("; peak torque %.2f, speed %.2f, power %.2f of the limits\n", jump.peak.torque_ratio,
              jump.peak.speed_ratio, jump.peak.power_ratio);
}

void say_refused(const RefusedPlan& refused) {
  std::fprintf(stderr, "hopscotch: no plan: %s\n", refused.refusal.text().c_str());
  if (!refused.nearest) return;
  const planner::StepRequest& step = refused.nearest->step;
  std::fprintf(stderr,
               "nearest feasible: %.3f m ahead, %+.3f m up, %+.3f m aside, turned %+.3f rad; "
               "%s has margin %.3f\n",
               step.distance, step.height, step.lateral, step.yaw,
               std::string(refused.nearest->binding.name).c_str(), refused.nearest->binding.margin);
}

/// What `hopscotch plan` works with.
struct PlanSession {
  ProgramConfig config;
  model::RobotParameters robot;
  planner::JumpPlanner planner;
  planner::PlanRequest request;
  PlanContext context;

  PlanSession(const PlanOptions& options, const ProgramConfig& tuning)
      : config(tuning),
        robot(model::RobotParameters::load(robot_file(options.robot))),
        planner(config.planner, robot, shipped_jumps(robot.name, config.planner.steps)),
        request(request_of(options, config, robot)),
        context{options.model, options.solver, {}, {}, options.repeat, {}} {}

  core::Result<core::JumpPlan> solve() {
    std::vector<double> solve_ms;
    std::optional<core::Result<core::JumpPlan>> result;
    for (int i = 0; i < context.solves; ++i) {
      const Stopwatch watch(TimeOf::thread);
      result = planner.plan(request);
      solve_ms.push_back(watch.milliseconds());
    }
    context.solve_ms = Percentiles::of(solve_ms);
    context.rung = planner::plan_rung_name(planner.rung());
    return std::move(*result);
  }
};

ExitStatus refuse(PlanSession& session, const PlanOptions& options, const core::Refusal& refusal) {
  RefusedPlan refused{options.step, refusal, session.planner.obstacle(),
                      session.planner.iterations(), std::nullopt};
  if (session.request.formulation == planner::Formulation::variable) {
    refused.nearest =
        planner::nearest_target(session.planner, session.request, options.step, session.robot);
  }
  if (options.json) {
    std::printf("%s", refused_plan_json(refused, session.context).c_str());
  } else {
    say_refused(refused);
  }
  return ExitStatus::answer_is_no;
}

/// With a film where one is wanted.
FlownJump fly(const FlightTrial& trial, const std::filesystem::path& video) {
  if (video.empty()) return fly(trial);
  Film film(flight_scene(trial), video);
  const std::string title =
      fixed(trial.step.distance, 2) + " m ahead, " + fixed(trial.step.height, 2) + " m up   ";
  int frame = 0;
  FlownJump flown = fly(trial, [&](const core::RobotState& state) {
    const double time = state.stamp.seconds();
    if (time < frame * Film::kStep) return;
    film.add(state, title + fixed(time, 2) + " s");
    ++frame;
  });
  film.finish();
  return flown;
}

ExitStatus plan(PlanOptions options) {
  planner::StepRequest& step = options.step;
  const bool own = options.model == "variable";
  if (options.solver.empty()) options.solver = own ? "chain" : "ipopt";
  if (!own) {
    if (options.solver != "ipopt") {
      throw core::ConfigError("plan: --solver " + options.solver +
                              " solves --model variable only; the others need ipopt");
    }
    if (step.lateral != 0.0 || step.yaw != 0.0) {
      throw core::ConfigError("plan: --model " + options.model +
                              " plans straight jumps only; --lateral and --yaw must be 0");
    }
  }
  if (std::isnan(step.edge)) step.edge = planner::default_edge(step.distance, step.height);
  ProgramConfig config = ProgramConfig::load(options.config);
  if (!std::isnan(options.friction)) config.planner.friction = options.friction;
  PlanSession session(options, config);
  const core::Result<core::JumpPlan> result = session.solve();
  if (!result) return refuse(session, options, result.error());
  PlanContext& context = session.context;
  if (options.fly) {
    context.flown = fly({*result, step, session.config, session.robot}, options.video);
  }
  if (!options.out.empty()) {
    write_file_atomically(options.out, plan_trajectory_json(*result, context));
  }
  if (options.json) {
    std::printf("%s", plan_summary_json(*result, context).c_str());
  } else {
    say_plan(*result, context);
    if (context.flown) say_flown(*context.flown);
  }
  const bool no = context.flown && context.flown->jump.outcome != JumpOutcome::landed;
  return no ? ExitStatus::answer_is_no : ExitStatus::ok;
}

}  // namespace

void add_plan_command(CLI::App& app, Action& action) {
  CLI::App* command =
      app.add_subcommand("plan", "One jump from standing: trajectory, certificate, time");
  command->footer("Example: hopscotch plan --distance 0.40 --height 0.10 --json");
  const auto options = std::make_shared<PlanOptions>();  // shared with the action below
  command->add_option("--distance", options->step.distance, "Ahead, sole to sole [m]")
      ->required()
      ->check(finite_number());
  command->add_option("--height", options->step.height, "Of the landing place [m]")
      ->check(finite_number());
  command
      ->add_option("--edge", options->step.edge,
                   "Where the ground changes height [m]; default 0.12 for a height below 0, "
                   "distance - 0.12 above")
      ->check(finite_number());
  command->add_option("--lateral", options->step.lateral, "To the left [m]")
      ->check(finite_number());
  command->add_option("--yaw", options->step.yaw, "Of the landing soles [rad]")
      ->check(finite_number());
  command->add_option("--robot", options->robot, "Robot file")->capture_default_str();
  command
      ->add_option("--friction", options->friction, "Of the ground, instead of the configured one")
      ->check(finite_number(0.05, 1.2));
  command
      ->add_option("--model", options->model,
                   "Formulation; all but the first are for comparison, and by Ipopt")
      ->check(CLI::IsMember({"variable", "paper", "full", "kinodynamic", "srbd"}))
      ->capture_default_str();
  command
      ->add_option("--solver", options->solver, "default chain; ipopt for models to compare with")
      ->check(CLI::IsMember({"chain", "ipopt"}));
  command->add_option("--repeat", options->repeat, "Solve so often")->check(whole_number(1, 10000));
  command->add_flag("--cold", options->cold,
                    "Each solve as the first: from the library or, without a jump close by, from "
                    "the closed form");
  command->add_option("--config", options->config, "Tuning")->capture_default_str();
  CLI::Option* const fly = command->add_flag(
      "--fly", options->fly, "Fly it in MuJoCo, on the true state, and say how it went");
  command->add_option("--video", options->video, "Write a film of the flight (MP4)")->needs(fly);
  command->add_option("--out", options->out, "Write the trajectory (JSON)");
  command->add_flag("--json", options->json, "Print one JSON object");
  command->callback([&action, options] { action = [options] { return plan(*options); }; });
}

}  // namespace hopscotch::apps
