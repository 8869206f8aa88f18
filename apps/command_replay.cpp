#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "apps/command_depth.hpp"
#include "apps/commands.hpp"
#include "apps/installation.hpp"
#include "apps/replay.hpp"
#include "apps/run_config.hpp"
#include "apps/scene_pictures.hpp"
#include "apps/text_file.hpp"

namespace hopscotch::apps {

namespace {

struct ReplayOptions {
  std::filesystem::path log;
  std::filesystem::path config;  ///< Empty: of the run folder, or the installed one.
  std::filesystem::path out;
  std::string robot;  ///< Likewise.
  DepthOptions depth;
  bool json = false;
};

std::string numbered(const char* stem, int number, const char* ending) {
  char name[64];
  std::snprintf(name, sizeof name, "%s-%03d%s", stem, number, ending);
  return name;
}

void draw(const std::filesystem::path& out, int number, const ReplayedLook& look) {
  draw_map(out / numbered("map", number, ".png"), look.map, look.report);
  if (look.frame != nullptr) {
    draw_over_depth(out / numbered("depth", number, ".png"), *look.frame, look.X_WC, look.report);
  }
}

void say(std::FILE* people, const ReplayedLook& look) {
  const core::TargetChoice& choice = look.report.choice;
  char target[64] = "no target";
  if (choice.target) {
    std::snprintf(target, sizeof target, "target %.3f m ahead, %+.3f m", choice.target->distance,
                  choice.target->height);
  }
  const bool compared = look.terrain_equal && look.target_equal;
  const bool equal = compared && *look.terrain_equal && *look.target_equal;
  std::fprintf(people, "%8.3f s  %-14s %zu edges, %zu gaps, %s%s%s\n", look.report.stamp.seconds(),
               look.report.status.c_str(), look.report.survey.features.edge_count,
               look.report.survey.features.gap_count, target,
               choice.target ? "" : (" (" + choice.refusal.text() + ")").c_str(),
               compared ? (equal ? "; as recorded" : "; DIFFERS from the record") : "");
}

void say(std::FILE* people, const ReplaySummary& summary) {
  if (summary.frames == 0) {
    std::fprintf(people, "no depth frames: perception was not run again (run --log-depth)\n");
  } else {
    std::fprintf(
        people, "%d frames, %d looks; differing from the record: %d terrains, %d targets\n",
        summary.frames, summary.looks, summary.terrains_differing, summary.targets_differing);
  }
  if (summary.homeless_readings > 0) {
    std::fprintf(
        people,
        "the log does not hold where the estimator began (a black box begins in mid-run, a "
        "run with --state truth has none): it was not run again\n");
  }
  if (summary.states.compared + summary.plans.compared == 0) return;
  std::fprintf(people, "differing from the record: %d of %d states, %d of %d plans\n",
               summary.states.differing, summary.states.compared, summary.plans.differing,
               summary.plans.compared);
}

/// What is to be looked at again, and with what.
struct Sources {
  std::filesystem::path log;
  std::filesystem::path config;
  std::filesystem::path robot;
};

Sources sources_of(const ReplayOptions& options) {
  Sources sources{options.log, options.config, {}};
  const RunFolder folder{options.log};
  const bool is_run = std::filesystem::is_regular_file(folder.log());
  if (is_run) sources.log = folder.log();
  if (sources.config.empty()) {
    sources.config = is_run ? folder.config() : config_directory() / "hopscotch.yaml";
  }
  const bool own = is_run && options.robot.empty();
  sources.robot = own ? believed_robot_file(folder)
                      : robot_file(options.robot.empty() ? "hector" : options.robot);
  return sources;
}

ExitStatus replay(const ReplayOptions& options) {
  const Sources sources = sources_of(options);
  const ProgramConfig config = ProgramConfig::load(sources.config);
  const model::RobotParameters robot = model::RobotParameters::load(sources.robot);
  if (!options.out.empty()) std::filesystem::create_directories(options.out);
  std::FILE* people = options.json ? stderr : stdout;
  std::string lines;
  int number = 0;
  const LookObserver observe = [&](const ReplayedLook& look) {
    const std::string line = terrain_json(look.report);
    if (options.json) std::printf("%s\n", line.c_str());
    say(people, look);
    if (options.out.empty()) return;
    lines += line + "\n";
    draw(options.out, number++, look);
  };
  const ReplaySummary summary =
      std::filesystem::is_directory(sources.log)
          ? replay_folder(sources.log, options.depth.scaling(), config, robot, observe)
          : replay_log(sources.log, config, robot, observe);
  if (!options.out.empty()) write_file_atomically(options.out / "terrain.jsonl", lines);
  say(people, summary);
  return summary.differing() == 0 ? ExitStatus::ok : ExitStatus::answer_is_no;
}

}  // namespace

void add_replay_command(CLI::App& app, Action& action) {
  CLI::App* command =
      app.add_subcommand("replay", "Runs a recorded log or a folder of depth images again");
  command->footer(
      "Estimator and planner run again, and perception and target choice if the log was recorded\n"
      "with `run --log-depth`. What comes out is compared bit by bit with what the log holds; "
      "exit\n"
      "status 1 says that something differs. A run folder is taken with its own tuning and robot.\n"
      "A folder of images holds 16-bit depth images and perhaps a text "
      "file *pose*.txt with a line \"[stamp] tx ty tz qx qy qz qw\" "
      "each.\n"
      "Example: hopscotch replay runs/stones-1 --out runs/stones-1/replay");
  const auto options = std::make_shared<ReplayOptions>();  // shared with the action below
  command->add_option("LOG", options->log, "Run folder, LCM log, or folder of depth images")
      ->required();
  command->add_option("--out", options->out, "Write pictures and terrain.jsonl to this folder");
  command->add_option("--robot", options->robot,
                      "Robot that recorded the log [of the run folder, else hector]");
  add_depth_options(*command, options->depth);
  command->add_option("--config", options->config,
                      "Tuning; also config.yaml of a run [of the run folder, else " +
                          (config_directory() / "hopscotch.yaml").string() + "]");
  command->add_flag("--json", options->json, "Print one JSON object for each look");
  command->callback([&action, options] { action = [options] { return replay(*options); }; });
}

}  // namespace hopscotch::apps
