#include "apps/campaign/slurm_engine.hpp"

#include <poll.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <optional>
#include <set>
#include <sstream>

#include "apps/campaign/external_command.hpp"
#include "apps/campaign/parts.hpp"
#include "apps/text_file.hpp"

namespace hopscotch::apps::campaign {

namespace fs = std::filesystem;

namespace {

constexpr double kClientTimeout = 20.0;  // [s]
constexpr int kClientFailures = 6;       // in a row, before the cluster counts as gone
constexpr int kIdleRounds = 3;           // without a single result, before the jobs count as broken
constexpr double kBetweenLooks = 1.0;    // [s]
constexpr std::size_t kChunkMost = 60;   // trials: minutes, so that starting an element is cheap
constexpr std::size_t kChunksWanted = 64;
constexpr const char* kMemory = "600M";  // a trial with camera takes a quarter of it

std::string first_word(const std::string& text) {
  std::istringstream stream(text);
  std::string word;
  stream >> word;
  return word;
}

void pause_for(double seconds) {
  poll(nullptr, 0, static_cast<int>(1e3 * seconds));  // ends early at a signal
}

/// The controller's limit of elements in an array.
std::size_t largest_array() {
  constexpr std::size_t kSlurmsDefault = 1001;
  const CommandAnswer answer = call({"scontrol", "show", "config"}, kClientTimeout);
  const std::size_t key = answer.output.find("MaxArraySize");
  if (answer.status != 0 || key == std::string::npos) return kSlurmsDefault - 1;
  const std::size_t equals = answer.output.find('=', key);
  return std::max<std::size_t>(2, std::strtoull(answer.output.c_str() + equals + 1, nullptr, 10)) -
         1;
}

/// One session with a cluster.
class SlurmSession {
 public:
  SlurmSession(const TrialMaker& maker, const SlurmRequest& request, Store& store,
               TrialQueue& queue)
      : request_(request),
        parts_{request.folder.path / "parts"},
        reader_(parts_, identity_of(maker)),
        store_(store),
        queue_(queue) {}

  EngineEnd run() {
    collect();
    find_again();
    Progress progress(queue_);
    Stopclock clock(store_);
    int idle_rounds = 0;
    while (!queue_.complete() && Interrupts::count() == 0) {
      const std::int64_t before = queue_.finished_count();
      if (job_.empty()) submit();
      wait_for_job(progress, clock);
      give_back_missing();
      idle_rounds = queue_.finished_count() > before ? 0 : idle_rounds + 1;
      if (idle_rounds >= kIdleRounds) {
        throw EngineError("the jobs end without results; their output is in " +
                          (parts_.path / "*.log").string());
      }
    }
    progress.finish(queue_);
    return queue_.complete() ? EngineEnd::complete : EngineEnd::interrupted;
  }

 private:
  void collect() {
    reader_.read_new([&](const TrialResult& result) {
      store_.add(result);
      queue_.finished(result.index, result.succeeded() ? TrialQueue::Verdict::success
                                                       : TrialQueue::Verdict::failure);
      missing_.erase(result.index);
    });
  }

  /// An array that an earlier session of this campaign has left behind, if it still runs.
  void find_again() {
    const std::string job = store_.note("slurm_job");
    if (job.empty() || !states_of(job)) return;
    job_ = job;
    for (std::optional<std::int64_t> index = queue_.next(); index; index = queue_.next()) {
      missing_.insert(*index);
    }
    std::fprintf(stderr, "goes on with job %s of the cluster\n", job.c_str());
  }

  /// How many elements are in which state, for people; nothing once the array has ended.
  std::optional<std::string> states_of(const std::string& job) {
    const CommandAnswer answer =
        call({"squeue", "--noheader", "--array", "--jobs", job, "--format", "%T"}, kClientTimeout);
    const bool unknown = answer.output.find("Invalid job id") != std::string::npos;
    if (answer.status != 0 && !unknown) {
      if (++client_failures_ >= kClientFailures) {
        throw EngineError("squeue does not answer: " + answer.output);
      }
      return "the controller does not answer";
    }
    client_failures_ = 0;
    if (unknown || answer.output.empty()) return std::nullopt;
    std::map<std::string, int> counts;
    std::istringstream lines(answer.output);
    for (std::string state; std::getline(lines, state);) ++counts[state];
    std::string text;
    for (const auto& [state, count] : counts) {
      text += (text.empty() ? "" : ", ") + std::to_string(count) + " " + state;
    }
    return "job " + job + ": " + text;
  }

  void submit() {
    std::vector<std::int64_t> trials;
    for (std::optional<std::int64_t> index = queue_.next(); index; index = queue_.next()) {
      trials.push_back(*index);
    }
    missing_.insert(trials.begin(), trials.end());
    const std::size_t most = largest_array();
    const std::size_t fair = std::clamp<std::size_t>(trials.size() / kChunksWanted, 1, kChunkMost);
    const std::size_t size = std::max(fair, (trials.size() + most - 1) / most);
    std::vector<std::vector<std::int64_t>> chunks;
    for (std::size_t i = 0; i < trials.size(); ++i) {
      if (i % size == 0) chunks.emplace_back();
      chunks.back().push_back(trials[i]);
    }
    const std::string noted = store_.note("slurm_round");
    const int round = noted.empty() ? 1 : std::stoi(noted) + 1;
    store_.set_note("slurm_round", std::to_string(round));
    parts_.write_round(round, chunks);
    send_array(round, chunks.size());
  }

  void send_array(int round, std::size_t chunks) {
    const fs::path script = parts_.path / ("round-" + std::to_string(round) + ".sh");
    write_file_atomically(script, "#!/bin/sh\nexec '" +
                                      fs::read_symlink("/proc/self/exe").string() + "' campaign '" +
                                      fs::absolute(request_.spec).string() + "' --out '" +
                                      fs::absolute(request_.folder.path).string() + "' --chunk " +
                                      std::to_string(round) + "/$SLURM_ARRAY_TASK_ID\n");
    const fs::path log = fs::absolute(parts_.path) / ("round-" + std::to_string(round) + "-%a.log");
    const CommandAnswer answer = call(
        {"sbatch", "--parsable", "--requeue", "--open-mode=append", "--ntasks=1",
         "--cpus-per-task=1", std::string("--mem=") + kMemory, "--job-name=hopscotch",
         "--array=0-" + std::to_string(chunks - 1), "--output=" + log.string(), script.string()},
        kClientTimeout);
    if (answer.status != 0) {
      const bool none = answer.status < 0 && !answer.timed_out;
      throw EngineError(none ? "there is no sbatch: the Slurm client is not installed"
                             : "sbatch refuses: " + answer.output);
    }
    const std::string words = answer.output.substr(0, answer.output.find(';'));
    job_ = first_word(words);
    store_.set_note("slurm_job", job_);
  }

  void wait_for_job(Progress& progress, Stopclock& clock) {
    while (Interrupts::count() == 0) {
      const std::optional<std::string> states = states_of(job_);
      collect();
      clock.tick();
      if (!states) break;
      progress.show(queue_, *states);
      // Results may all be here before the controller has cleared the last element.
      if (missing_.empty()) break;
      pause_for(kBetweenLooks);
    }
    if (Interrupts::count() > 0) (void)call({"scancel", job_}, kClientTimeout);
    collect();
    job_.clear();
    store_.set_note("slurm_job", "");
  }

  void give_back_missing() {
    for (const std::int64_t index : missing_) queue_.give_back(index);
    missing_.clear();
  }

  SlurmRequest request_;
  PartsFolder parts_;
  PartsReader reader_;
  Store& store_;
  TrialQueue& queue_;
  std::string job_;                 ///< Of the array that runs; empty: none.
  std::set<std::int64_t> missing_;  ///< Given to it and not back yet.
  int client_failures_ = 0;
};

}  // namespace

EngineEnd run_slurm(const TrialMaker& maker, const SlurmRequest& request, Store& store,
                    TrialQueue& queue) {
  return SlurmSession(maker, request, store, queue).run();
}

}  // namespace hopscotch::apps::campaign
