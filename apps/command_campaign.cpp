#include <csignal>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "apps/campaign/analysis.hpp"
#include "apps/campaign/campaign.hpp"
#include "apps/campaign/comparison.hpp"
#include "apps/campaign/parts.hpp"
#include "apps/campaign/slurm_engine.hpp"
#include "apps/campaign/trial_run.hpp"
#include "apps/command_campaign.hpp"
#include "apps/commands.hpp"
#include "apps/html.hpp"
#include "apps/option_check.hpp"
#include "apps/text_file.hpp"
#include "core/config_reader.hpp"

namespace hopscotch::apps {

namespace fs = std::filesystem;

namespace {

struct CampaignOptions {
  fs::path spec;
  fs::path out;
  int jobs = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  std::string engine = "local";
  bool resume = false;
  std::optional<std::int64_t> trial;
  fs::path compare;
  std::vector<fs::path> merge;
  std::string chunk;  ///< "ROUND/CHUNK": this call is a job of the cluster.
  bool json = false;
};

std::string again(const CampaignOptions& options, const std::string& more) {
  return "hopscotch campaign " + options.spec.string() + " --out " + options.out.string() + " " +
         more;
}

ExitStatus run_one(const CampaignOptions& options, const campaign::TrialMaker& maker) {
  const std::int64_t count = maker.spec().cells() * maker.spec().trials;
  if (*options.trial < 0 || *options.trial >= count) {
    throw core::ConfigError("--trial " + std::to_string(*options.trial) + ", but 0 <= INDEX < " +
                            std::to_string(count));
  }
  const campaign::CampaignFolder folder{options.out};
  const fs::path out = folder.run(*options.trial);
  const RunResult run = campaign::record_trial(maker, *options.trial, out);
  std::FILE* people = options.json ? stderr : stdout;
  std::fprintf(people, "trial %lld: %s%s%s\nrun folder: %s\n",
               static_cast<long long>(*options.trial),
               std::string(run_outcome_name(run.outcome)).c_str(), run.reason.empty() ? "" : ", ",
               run.reason.c_str(), out.c_str());
  if (options.json) std::printf("%s", to_json(run).c_str());
  return run.outcome == RunOutcome::completed ? ExitStatus::ok : ExitStatus::answer_is_no;
}

void say_comparison(const campaign::Comparison& comparison, std::FILE* people) {
  const campaign::PairedDifference result = campaign::compare_paired(comparison.total);
  std::fprintf(people,
               "against %s: %+.1f percent points (95 %%: %+.1f to %+.1f), p = %.2g, %lld pairs\n",
               comparison.name_b.c_str(), 100.0 * result.difference, 100.0 * result.interval95.low,
               100.0 * result.interval95.high, result.p_value,
               static_cast<long long>(comparison.total.total()));
}

void say_results(const CampaignOptions& options, const campaign::Analysis& analysis,
                 std::FILE* people) {
  const campaign::Interval interval = analysis.total.interval();
  std::fprintf(people, "%s: %lld of %lld trials succeeded, %s %% (95 %%: %s to %s %%)\n",
               analysis.identity.name.c_str(), static_cast<long long>(analysis.total.succeeded),
               static_cast<long long>(analysis.total.trials),
               fixed(100.0 * analysis.total.rate(), 1).c_str(),
               fixed(100.0 * interval.low, 1).c_str(), fixed(100.0 * interval.high, 1).c_str());
  for (const campaign::FailureClass& failure : analysis.failures) {
    std::fprintf(people, "  %lld x %s, e.g. %s\n", static_cast<long long>(failure.count),
                 failure.cause.c_str(),
                 again(options, "--trial " + std::to_string(failure.examples.front())).c_str());
  }
}

ExitStatus run_all(const CampaignOptions& options, const campaign::TrialMaker& maker) {
  const campaign::CampaignFolder folder{options.out};
  const bool adds = options.resume || !options.compare.empty() || !options.merge.empty();
  if (fs::exists(folder.store()) && !adds) {
    throw core::ConfigError(options.out.string() +
                            ": holds a campaign already; --resume goes on with it");
  }
  const campaign::FolderLock lock(folder);
  std::signal(SIGXFSZ, SIG_IGN);  // a file too large is to be an error, not a death
  const campaign::Interrupts interrupts;
  campaign::EngineEnd end = campaign::EngineEnd::interrupted;
  {
    campaign::Store store(folder.store(), campaign::identity_of(maker));
    store.set_note("engine", options.engine);
    if (!options.compare.empty()) campaign::compare_with(options.compare, store);
    for (const fs::path& other : options.merge) {
      const std::int64_t added = campaign::merge(campaign::CampaignFolder{other}.store(), store);
      std::fprintf(stderr, "merged %lld trials of %s\n", static_cast<long long>(added),
                   other.c_str());
    }
    campaign::TrialQueue queue(maker.spec());
    campaign::skip_finished(store, queue);
    end = options.engine == "slurm"
              ? campaign::run_slurm(maker, {options.spec, folder}, store, queue)
              : campaign::run_local(maker, options.jobs, store, queue);
    if (end == campaign::EngineEnd::complete) {
      campaign::keep_runs(maker, options.jobs, folder, store);
    }
  }
  if (campaign::Interrupts::count() < 2) campaign::write_results(folder);
  if (end == campaign::EngineEnd::interrupted) {
    std::fprintf(stderr, "hopscotch: stopped; what is done is saved. To go on: %s\n",
                 again(options, "--resume").c_str());
    return ExitStatus::answer_is_no;
  }
  const campaign::Store store(folder.store());
  say_results(options, campaign::analyse(store), options.json ? stderr : stdout);
  if (!options.compare.empty()) {
    const campaign::Store other(campaign::CampaignFolder{options.compare}.store());
    say_comparison(campaign::compare(store, other), options.json ? stderr : stdout);
  }
  std::fprintf(options.json ? stderr : stdout, "report: %s\n", folder.report().c_str());
  if (options.json) std::printf("%s", read_file(folder.summary()).c_str());
  return ExitStatus::ok;
}

ExitStatus run(const CampaignOptions& options) {
  const campaign::CampaignSpec spec = campaign::CampaignSpec::load(options.spec);
  const campaign::TrialMaker maker(spec);
  if (!options.chunk.empty()) {
    campaign::run_chunk(maker, {options.out / "parts"}, options.chunk);
    return ExitStatus::ok;
  }
  return options.trial ? run_one(options, maker) : run_all(options, maker);
}

}  // namespace

void add_campaign_command(CLI::App& app, Action& action) {
  CLI::App* command = app.add_subcommand(
      "campaign", "Many seeded runs: success rates with intervals, failure classes, a report");
  command->footer(
      "Example: hopscotch campaign config/campaigns/repeatability.yaml --out runs/repeatability");
  const auto options = std::make_shared<CampaignOptions>();  // shared with the action below
  command->add_option("SPEC", options->spec, "Campaign file (YAML)")->required();
  command->add_option("--out", options->out, "Folder of the campaign")->required();
  command->add_option("--jobs", options->jobs, "Worker processes")
      ->check(whole_number(1, 1024))
      ->capture_default_str();
  command->add_option("--engine", options->engine, "What runs the trials")
      ->check(CLI::IsMember({"local", "slurm"}))
      ->capture_default_str();
  command->add_flag("--resume", options->resume, "Go on with the campaign in the folder");
  command->add_option("--trial", options->trial, "Run this one again, alone, with its log")
      ->check(whole_number(0, std::numeric_limits<std::int64_t>::max()));
  command->add_option("--compare", options->compare,
                      "Folder of a campaign on the same draws: paired differences");
  command->add_option("--merge", options->merge,
                      "Folders of the same campaign run elsewhere: takes over their trials");
  command->add_option("--chunk", options->chunk, "For jobs of the cluster: ROUND/CHUNK")
      ->group("");  // not for people
  command->add_flag("--json", options->json, "Print summary.json on standard output");
  command->callback([&action, options] { action = [options] { return run(*options); }; });
}

}  // namespace hopscotch::apps
