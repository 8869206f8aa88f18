#include "apps/command_operator.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <optional>
#include <thread>
#include <vector>

#include "apps/command_gate.hpp"
#include "apps/live_run.hpp"
#include "apps/operator_client.hpp"
#include "apps/option_check.hpp"
#include "apps/stopwatch.hpp"
#include "core/config_reader.hpp"

namespace hopscotch::apps {

namespace {

constexpr double kListen = 2.0;  // for a run to tell its status [s]

/// A run to talk to, or why there is none.
struct Found {
  std::optional<std::uint64_t> run;
  std::string why_not;
};

Found only(const RunOnAir& run) {
  if (run.is_alone) return {run.id, ""};
  return {{},
          "several runs with the id " + run_id_text(run.id) +
              " are on, of the same scenario and seed: all would do it; stop all but one"};
}

Found find_run(const AskOptions& options, OperatorClient& client) {
  const std::vector<RunOnAir> runs = client.running(kListen);
  std::string list;
  for (const RunOnAir& run : runs) list += " " + run_id_text(run.id);
  if (runs.empty()) {
    return {{}, "nobody answered: no run is on (start one with `hopscotch run SCENARIO --pace 1`)"};
  }
  if (options.run.empty()) {
    if (runs.size() == 1) return only(runs.front());
    return {{}, "several runs are on, choose one with --run:" + list};
  }
  std::uint64_t wanted = 0;
  if (!parse_run_id(options.run, wanted)) {
    throw core::ConfigError("--run " + options.run + ": a run id is up to 16 hexadecimal digits");
  }
  for (const RunOnAir& run : runs) {
    if (run.id == wanted) return only(run);
  }
  return {{}, "nobody answered: run " + options.run + " is not on, but:" + list};
}

std::string in_words(const msgs::Ack& ack) {
  if (!ack.accepted) return "refused: " + ack.refusal.text();
  std::string text = "accepted";
  if (!ack.refusal.sentence.empty()) text += ": " + ack.refusal.sentence;
  if (ack.start_in > 0.0) {
    char when[48];
    std::snprintf(when, sizeof when, ", in %.2f s of the run's time", ack.start_in);
    text += when;
  }
  return text;
}

/// A jump that has taken off is locked; the wish is for the next one and is asked again once that
/// is open. Other refusals are final.
std::optional<msgs::Ack> ask_until_open(OperatorClient& client, core::OperatorCommand command,
                                        double patience) {
  constexpr double kSoonest = 0.05;  // between two questions [s]
  constexpr double kLatest = 0.3;    // a run need not go at the pace of the clock [s]
  const Stopwatch watch;
  for (;;) {
    command.sequence = wall_clock_us();
    const double left = patience - 1e-3 * watch.milliseconds();
    std::optional<msgs::Ack> ack = client.ask(command, left);
    const bool locked = ack && !ack->accepted && std::isfinite(ack->start_in);
    if (!locked) return ack;
    const double wait = std::clamp(ack->start_in, kSoonest, kLatest);
    if (1e-3 * watch.milliseconds() + wait >= patience) return ack;
    std::this_thread::sleep_for(std::chrono::duration<double>(wait));
  }
}

std::string in_json(const std::optional<msgs::Ack>& ack, const std::string& run,
                    const std::string& words) {
  nlohmann::ordered_json json = {{"schema", "hopscotch.answer/1"}, {"run_id", run}};
  json["answered"] = ack.has_value();
  json["accepted"] = ack && ack->accepted;
  json["reason"] = ack ? std::string(core::reason_code(ack->refusal.reason)) : "nobody_answered";
  json["sentence"] = ack ? ack->refusal.sentence : words;
  const bool timed = ack && std::isfinite(ack->start_in);
  json["start_in_s"] = timed ? nlohmann::ordered_json(ack->start_in) : nlohmann::ordered_json();
  return json.dump() + "\n";
}

}  // namespace

void add_ask_options(CLI::App& command, AskOptions& options) {
  command.add_option("--run", options.run, "Id of the run, when several are on");
  command.add_option("--patience", options.patience, "How long to wait for the answer [s]")
      ->check(finite_number(0.1, 3600.0))
      ->capture_default_str();
  command.add_flag("--json", options.json, "Print the answer as JSON on standard output");
}

ExitStatus ask_run(const AskOptions& options, core::OperatorCommand command) {
  OperatorClient client(live_url());
  const Found found = find_run(options, client);
  std::optional<msgs::Ack> ack;
  std::string words = found.why_not;
  std::string run = options.run;
  if (found.run) {
    run = run_id_text(*found.run);
    command.run_id = *found.run;
    ack = ask_until_open(client, command, options.patience);
    words = ack ? in_words(*ack) : "nobody answered: run " + run + " was on, but gave no answer";
  }
  std::fprintf(options.json ? stderr : stdout, "%s\n", words.c_str());
  if (options.json) std::printf("%s", in_json(ack, run, words).c_str());
  return ack && ack->accepted ? ExitStatus::ok : ExitStatus::answer_is_no;
}

}  // namespace hopscotch::apps
