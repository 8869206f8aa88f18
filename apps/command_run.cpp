#include <atomic>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <thread>

#include "apps/command_gate.hpp"
#include "apps/commands.hpp"
#include "apps/html.hpp"
#include "apps/installation.hpp"
#include "apps/key_frames.hpp"
#include "apps/live_run.hpp"
#include "apps/lockstep_run.hpp"
#include "apps/option_check.hpp"
#include "apps/pacer.hpp"
#include "apps/report.hpp"
#include "apps/run_attendant.hpp"
#include "apps/run_config.hpp"
#include "apps/run_recorder.hpp"
#include "apps/stopwatch.hpp"
#include "apps/text_file.hpp"
#include "apps/video.hpp"
#include "apps/view.hpp"
#include "apps/web_run.hpp"

namespace hopscotch::apps {

namespace fs = std::filesystem;

namespace {

struct RunOptions {
  fs::path scenario;
  fs::path config = config_directory() / "hopscotch.yaml";
  fs::path out;
  std::uint64_t seed = 1;
  int jumps = 0;
  std::string perception = "camera";
  std::string state = "estimate";
  std::string ablation = "none";
  double pace = 0.0;
  bool threads = false;
  bool video = false;
  bool view = false;
  bool serve = false;
  int port = kWebPort;
  bool lcm = false;
  bool no_pictures = false;
  bool log_depth = false;
  bool json = false;
};

std::atomic<bool> interrupted{false};  // set by the signal handler, hence at namespace scope

extern "C" void on_interrupt(int) {
  interrupted = true;
}

struct Prepared {
  RunRequest request;
  RunSources sources;
};

Prepared prepare(const RunOptions& options) {
  Prepared prepared;
  RunRequest& request = prepared.request;
  request.scenario = sim::Scenario::load(options.scenario);
  request.config = ProgramConfig::load(options.config);
  request.robot = model::RobotParameters::load(robot_file(request.scenario.robot));
  request.plant_robot = model::RobotParameters::load(robot_file(request.scenario.plant.robot));
  request.threading = options.threads ? Threading::threads : Threading::lockstep;
  request.seed = options.seed;
  request.jumps_max = options.jumps;
  request.state = options.state == "truth" ? StateSource::truth : StateSource::estimate;
  request.ablation = core::ablation_from_name(options.ablation).value();  // checked by the parser
  request.log_depth = options.log_depth;
  request.eyes = options.perception == "truth" ? Eyes::truth : Eyes::camera;
  prepared.sources = {read_file(options.scenario), tuning_text(options.config),
                      robot_text(request.scenario.plant.robot)};
  return prepared;
}

/// Live channels are for runs that somebody watches. Without --lcm they are a convenience: a
/// machine that cannot carry them runs without.
std::unique_ptr<LiveRun> open_live(const RunOptions& options, std::uint64_t id, CommandBox& box) {
  const bool paced = options.pace > 0.0 || options.view || options.serve || options.threads;
  if (!options.lcm && !paced) return nullptr;
  try {
    return std::make_unique<LiveRun>(live_url(), box, id);
  } catch (const msgs::LiveUnavailable& error) {
    if (options.lcm) throw;
    std::fprintf(stderr, "hopscotch: %s. The run goes on without them.\n", error.what());
    return nullptr;
  }
}

/// Everything but commands: those came from the network.
RunRecorder::Listener to_network(LiveRun& live) {
  return [&live](const msgs::Event& event) {
    const bool command =
        event.channel == msgs::kTargetCommandChannel || event.channel == msgs::kModeCommandChannel;
    if (!command) live.publish(event);
  };
}

/// Who watches a run besides its recorder.
struct Watchers {
  std::unique_ptr<LiveRun> live;
  std::unique_ptr<WebRun> page;
  std::unique_ptr<LiveView> window;

  [[nodiscard]] bool closed() const { return window && window->closed(); }
};

Watchers open_watchers(const RunOptions& options, std::uint64_t id, const RunRequest& request,
                       CommandBox& box) {
  Watchers watchers;
  watchers.live = open_live(options, id, box);
  if (options.serve) watchers.page = std::make_unique<WebRun>(options.port, id, request, box);
  if (options.view) watchers.window = std::make_unique<LiveView>(request);
  return watchers;
}

/// From the first tick to the last. @return what came of it but for identity.
RunResult simulate(const RunOptions& options, const RunRequest& request, RunRecorder& recorder,
                   RunAttendant& attendant, Watchers& watchers) {
  if (watchers.live) recorder.add_listener(to_network(*watchers.live));
  if (watchers.page) {
    recorder.add_listener([&](const msgs::Event& event) { watchers.page->show(event); });
  }
  LockstepRun simulation(request);
  const bool watched = options.view || options.serve || options.threads;
  const double pace = options.pace > 0.0 ? options.pace : (watched ? 1.0 : 0.0);
  Pacer pacer = options.threads ? Pacer(pace, request.config.threads.control) : Pacer(pace);
  const auto observe = [&](const TickRecord& tick) {
    recorder.record(tick);
    attendant.note(tick.events);
    if (watchers.window) watchers.window->show(tick.truth.state);
  };
  while (simulation.step(observe)) {
    pacer.wait(simulation.now());
    if (interrupted || watchers.closed()) simulation.stop();
    attendant.attend(simulation);
    if (watchers.page) watchers.page->attend(simulation);
  }
  attendant.close(simulation.now());
  RunResult result = simulation.result();
  result.timing.real_time_factor = 1e3 * result.duration / pacer.elapsed_ms();
  result.timing.deadline_misses =
      static_cast<int>(pacer.missed() + simulation.pipeline().late_results());
  return result;
}

void say_jump(const JumpResult& jump, std::FILE* people) {
  const bool stands = std::isfinite(jump.landing.distance);
  std::fprintf(people, "  jump %d: %.2f m ahead, %+.2f m -> %s%s%s%s\n", jump.index,
               jump.target.distance, jump.target.height,
               std::string(jump_outcome_name(jump.outcome)).c_str(),
               stands ? (" at " + fixed(jump.landing.distance, 3) + " m").c_str() : "",
               jump.reason.empty() ? "" : ": ", jump.reason.c_str());
}

void say_result(const RunResult& result, const RunFolder& folder, std::FILE* people) {
  for (const JumpResult& jump : result.jumps) say_jump(jump, people);
  if (const JumpTimes times = jump_times(result.jumps); times.count > 0) {
    std::fprintf(people, "  %.3f s from jump to jump, 95 %% within %.3f s\n", times.mean,
                 times.p95);
  }
  std::fprintf(people, "%s: %s after %.1f s and %zu jump%s%s%s (real-time factor %.1f)\n",
               result.scenario.c_str(), std::string(run_outcome_name(result.outcome)).c_str(),
               result.duration, result.jumps.size(), result.jumps.size() == 1 ? "" : "s",
               result.reason.empty() ? "" : ", ", result.reason.c_str(),
               result.timing.real_time_factor);
  std::fprintf(people, "run folder: %s\nreport:     %s\n", folder.path.c_str(),
               folder.report().c_str());
}

ExitStatus exit_status(RunOutcome outcome) {
  const bool ok = outcome == RunOutcome::completed || outcome == RunOutcome::stopped;
  return ok ? ExitStatus::ok : ExitStatus::answer_is_no;
}

ExitStatus run(const RunOptions& options) {
  std::FILE* people = options.json ? stderr : stdout;
  const Prepared prepared = prepare(options);
  const std::uint64_t id = run_identity(prepared.sources, prepared.request);
  const fs::path out =
      options.out.empty()
          ? fs::path("runs") / (prepared.request.scenario.name + "-" + std::to_string(options.seed))
          : options.out;
  std::fprintf(people, "%s, seed %llu: perception %s, state %s\n",
               prepared.request.scenario.name.c_str(),
               static_cast<unsigned long long>(options.seed), options.perception.c_str(),
               options.state.c_str());

  RunRecorder recorder(out, id, prepared.request, prepared.sources);
  RunAttendant attendant(id, recorder);
  Watchers watchers = open_watchers(options, id, prepared.request, attendant.box());
  if (watchers.page) {
    std::fprintf(people, "page: %s\n", watchers.page->url().c_str());
    std::fflush(people);
  }
  std::signal(SIGINT, on_interrupt);
  RunResult result = simulate(options, prepared.request, recorder, attendant, watchers);
  result.run_id = run_id_text(id);
  result.program = std::string(program_version());
  const RunFolder folder = recorder.finish(result);
  if (!options.no_pictures) {
    if (const auto missing = draw_key_frames(folder)) {
      std::fprintf(stderr, "hopscotch: the report goes without pictures: %s\n", missing->c_str());
    }
  }
  write_report(folder.path);
  if (options.video) write_video(folder);
  say_result(result, folder, people);
  if (watchers.page) watchers.page->finish(read_file(folder.result()));
  if (options.json) std::printf("%s", read_file(folder.result()).c_str());
  return exit_status(result.outcome);
}

}  // namespace

void add_run_command(CLI::App& app, Action& action) {
  CLI::App* command =
      app.add_subcommand("run", "Autonomous continuous jumping in the MuJoCo terrain simulation");
  command->footer("Example: hopscotch run config/scenarios/rising-boxes.yaml --video");
  const auto options = std::make_shared<RunOptions>();  // shared with the action below
  command->add_option("SCENARIO", options->scenario, "Scenario file (YAML)")->required();
  command->add_option("--seed", options->seed, "Of noise and start variation")
      ->check(whole_number())
      ->capture_default_str();
  command->add_option("--jumps", options->jumps, "Stop after so many jumps")
      ->check(whole_number(1, 100000));
  command->add_option("--perception", options->perception, "What the robot sees the terrain with")
      ->check(CLI::IsMember({"camera", "truth"}))
      ->capture_default_str();
  command->add_option("--state", options->state, "What the robot knows its state by")
      ->check(CLI::IsMember({"estimate", "truth"}))
      ->capture_default_str();
  command->add_option("--ablation", options->ablation, "Leave a part of the method out")
      ->check(CLI::IsMember(
          std::vector<std::string>(core::kAblationNames.begin(), core::kAblationNames.end())))
      ->capture_default_str();
  command->add_option("--out", options->out, "Run folder [runs/<scenario>-<seed>]");
  command->add_option("--config", options->config, "Tuning")->capture_default_str();
  command->add_option("--pace", options->pace, "Times real time; without it as fast as it goes")
      ->check(finite_number(0.01, 100.0));
  command->add_flag(
      "--threads", options->threads,
      "Stages on threads of their own, paced by the clock: repeats no more to the bit");
  command->add_flag("--video", options->video, "Write video.mp4");
  command->add_flag("--log-depth", options->log_depth,
                    "Record depth frames too, so that `hopscotch replay` can look again");
  command->add_flag("--no-pictures", options->no_pictures, "Report without key frames: faster");
  command->add_flag("--view", options->view, "Show it in a window, in real time");
  command->add_flag("--serve", options->serve,
                    "Show it in a browser on this machine, in real time");
  command->add_option("--port", options->port, "Of the page; 0: any that is free")
      ->check(whole_number(0, 65535))
      ->capture_default_str();
  command->add_flag("--lcm", options->lcm,
                    "Live LCM channels and commands; --pace, --view and --serve have them too");
  command->add_flag("--json", options->json, "Print result.json on standard output");
  command->callback([&action, options] { action = [options] { return run(*options); }; });
}

}  // namespace hopscotch::apps
