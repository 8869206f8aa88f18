#include <cstdio>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "apps/bench.hpp"
#include "apps/commands.hpp"
#include "apps/installation.hpp"
#include "apps/option_check.hpp"
#include "core/config_reader.hpp"

namespace hopscotch::apps {

namespace {

struct BenchOptions {
  std::string what;
  std::filesystem::path qps;
  int jumps = 20;
  int targets = 500;
  FlightSample fly;
  bool compare = false;
  bool json = false;
};

/// The processor's own name and the instruction set that this build uses.
std::string machine() {
  std::ifstream info("/proc/cpuinfo");
  std::string name = "unknown processor";
  for (std::string line; std::getline(info, line);) {
    if (line.rfind("model name", 0) == 0) {
      name = line.substr(line.find(':') + 2);
      break;
    }
  }
#if defined(__AVX512F__)
  return name + ", AVX-512";
#elif defined(__AVX2__)
  return name + ", AVX2";
#else
  return name + ", baseline instruction set";
#endif
}

nlohmann::ordered_json measure(const BenchOptions& options) {
  const BenchSetup setup{ProgramConfig::load(config_directory() / "hopscotch.yaml"),
                         model::RobotParameters::load(robot_file("hector"))};
  if (options.what == "planner") {
    if (options.fly.flights > 0) return bench_flights(setup, options.fly);
    return options.compare ? bench_formulations(setup) : bench_planner(setup, options.targets);
  }
  if (options.what == "mpc") return bench_mpc(setup, options.qps);
  if (options.what == "perception") return bench_perception(setup);
  if (options.what == "wire") return bench_wire();
  if (options.what == "estimator") return bench_estimator(setup, options.jumps);
  if (options.what == "tick") return bench_tick(setup);
  return bench_sim(setup);
}

void print_comparison(const nlohmann::ordered_json& rows) {
  std::printf("%-24s %-12s %10s %6s %9s %9s %9s\n", "jump", "model", "solve ms", "iter.",
              "missed by", "promised", "flown");
  for (const auto& row : rows) {
    const auto cell = [&row](const char* key, double scale, const char* unit) {
      char text[32] = "-";
      if (row.contains(key) && row[key].is_number()) {
        std::snprintf(text, sizeof text, "%.2f %s", scale * row[key].get<double>(), unit);
      }
      return std::string(text);
    };
    std::printf("%-24s %-12s %10.1f %6d %9s %9s %9s  %s\n", row["jump"].get<std::string>().c_str(),
                row["model"].get<std::string>().c_str(), row["solve_ms"].get<double>(),
                row["iterations"].get<int>(), cell("landing_error_m", 100.0, "cm").c_str(),
                cell("promised_speed_z_mps", 1.0, "m/s").c_str(),
                cell("flown_speed_z_mps", 1.0, "m/s").c_str(),
                row["outcome"].get<std::string>().c_str());
  }
}

void print_people(const nlohmann::ordered_json& json) {
  for (const auto& [key, value] : json.items()) {
    if (value.is_object() && value.contains("p50")) {
      std::printf("%-22s p50 %-10.4g p99 %-10.4g max %.4g\n", key.c_str(),
                  value["p50"].get<double>(), value["p99"].get<double>(),
                  value["max"].get<double>());
    } else if (key == "compare") {
      print_comparison(value);
    } else {
      std::printf("%-22s %s\n", key.c_str(),
                  value.is_string() ? value.get<std::string>().c_str() : value.dump().c_str());
    }
  }
}

/// Options that only one of the benchmarks has, each with its name.
using OptionsOfOne = std::vector<std::pair<CLI::Option*, std::string>>;

OptionsOfOne add_options_of_one(CLI::App& command, BenchOptions& options) {
  CLI::Option* const qps = command.add_option("--qps", options.qps, "mpc: a file of recorded QPs");
  CLI::Option* const jumps =
      command.add_option("--jumps", options.jumps, "estimator: so many jumps")
          ->check(whole_number(1, 100000))
          ->capture_default_str();
  CLI::Option* const fly = command.add_option("--fly", options.fly.flights,
                                              "planner: plan and fly so many of its targets");
  fly->check(whole_number(1, 1000));
  CLI::Option* const seed =
      command.add_option("--seed", options.fly.seed,
                         "planner --fly: draw jumps from between the targets; 0: targets, evenly");
  seed->check(whole_number())->needs(fly);
  CLI::Option* const targets =
      command.add_option("--targets", options.targets, "planner: so many of its targets, evenly")
          ->check(whole_number(1, 500))
          ->excludes(fly)
          ->capture_default_str();
  CLI::Option* const compare =
      command.add_flag("--compare", options.compare,
                       "planner: against other formulations of the same jumps, flown in MuJoCo");
  compare->excludes(fly)->excludes(targets);
  return {{qps, "mpc"},      {jumps, "estimator"}, {fly, "planner"},
          {seed, "planner"}, {targets, "planner"}, {compare, "planner"}};
}

void refuse_options_of_others(const OptionsOfOne& known, const std::string& what) {
  for (const auto& [option, bench] : known) {
    if (option->count() == 0 || bench == what) continue;
    throw core::ConfigError(option->get_name() + ": is an option of `bench " + bench + "` alone");
  }
}

ExitStatus bench(const BenchOptions& options) {
  nlohmann::ordered_json json;
  json["schema"] = "hopscotch.bench/1";
  json["bench"] = options.what;
  json["machine"] = machine();
  json.update(measure(options));
  if (options.json) {
    std::printf("%s\n", json.dump(2).c_str());
  } else {
    print_people(json);
  }
  return ExitStatus::ok;
}

}  // namespace

void add_bench_command(CLI::App& app, Action& action) {
  CLI::App* command =
      app.add_subcommand("bench", "The figures that the README quotes, measured here");
  command->footer("Example: hopscotch bench planner --json");
  const auto options = std::make_shared<BenchOptions>();  // shared with the action below
  command
      ->add_option("WHAT", options->what, "planner, mpc, perception, estimator, sim, tick or wire")
      ->required()
      ->check(CLI::IsMember({"planner", "mpc", "perception", "estimator", "sim", "tick", "wire"}));
  const OptionsOfOne of_one = add_options_of_one(*command, *options);
  command->add_flag("--json", options->json, "Print one JSON object");
  command->callback([&action, options, of_one] {
    refuse_options_of_others(of_one, options->what);
    action = [options] { return bench(*options); };
  });
}

}  // namespace hopscotch::apps
