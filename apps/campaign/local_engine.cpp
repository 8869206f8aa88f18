#include <map>

#include "apps/campaign/engine.hpp"
#include "apps/campaign/trial_run.hpp"
#include "apps/campaign/worker_pool.hpp"
#include "core/reason.hpp"

namespace hopscotch::apps::campaign {

namespace {

constexpr double kPatience = 0.2;  // [s] between looks at interrupts and progress

/// Worker processes that run trials. A worker may have been killed from outside or starved, so a
/// death is the trial's own only if it repeats.
class TrialWorkers {
 public:
  TrialWorkers(const TrialMaker& maker, int jobs)
      : maker_(maker), pool_(jobs, maker.spec().trial_timeout, [&maker](std::int64_t index) {
          return to_line(run_trial(maker, index));
        }) {}

  /// A trial is being run, and tried again if need be.
  void start(std::int64_t index) { pool_.start(index); }
  [[nodiscard]] bool has_room() const { return pool_.has_room(); }
  [[nodiscard]] bool idle() const { return pool_.idle(); }
  void kill_all() { pool_.kill_all(); }

  /// Waits at most so long [s] for results.
  /// @param lost What is to become of trials whose workers died: tried again or left.
  enum class Lost : std::uint8_t { again, left };
  std::vector<TrialResult> wait(double seconds, Lost lost) {
    std::vector<TrialResult> results;
    for (const WorkerAnswer& answer : pool_.wait(seconds)) {
      if (answer.end == WorkerEnd::answered) {
        results.push_back(result_from_line(answer.text));
        continue;
      }
      const int most = answer.end == WorkerEnd::hung ? kHangs : kCrashes;
      if (++attempts_[answer.job] >= most) {
        results.push_back(lost_result(answer));
      } else if (lost == Lost::again) {
        pool_.start(answer.job);
      }
    }
    return results;
  }

 private:
  [[nodiscard]] TrialResult lost_result(const WorkerAnswer& answer) const {
    const TrialSetup setup = maker_.setup(answer.job);
    TrialResult result;
    result.index = answer.job;
    result.seed = setup.seed;
    result.values = setup.values;
    const bool hung = answer.end == WorkerEnd::hung;
    result.outcome = hung ? "hung" : "crashed";
    // Ends of the worker, not of the robot: no reason of the core has these words.
    result.cause = hung ? "trial_hung" : "trial_crashed";
    if (answer.end == WorkerEnd::failed) {
      result.cause = core::reason_code(core::Reason::internal_error);
    }
    result.sentence =
        hung ? "no end within " + exact_text(maker_.spec().trial_timeout) + " s" : answer.text;
    return result;
  }

  const TrialMaker& maker_;
  WorkerPool pool_;
  std::map<std::int64_t, int> attempts_;
};

}  // namespace

EngineEnd run_local(const TrialMaker& maker, int jobs, Store& store, TrialQueue& queue) {
  TrialWorkers workers(maker, jobs);
  Progress progress(queue);
  Stopclock clock(store);
  while (true) {
    if (Interrupts::count() > 1) workers.kill_all();
    const bool ending = Interrupts::count() > 0;
    while (!ending && workers.has_room()) {
      const std::optional<std::int64_t> index = queue.next();
      if (!index) break;
      workers.start(*index);
    }
    if (workers.idle()) break;
    const TrialWorkers::Lost lost = ending ? TrialWorkers::Lost::left : TrialWorkers::Lost::again;
    for (const TrialResult& result : workers.wait(kPatience, lost)) {
      store.add(result);
      queue.finished(result.index, result.succeeded() ? TrialQueue::Verdict::success
                                                      : TrialQueue::Verdict::failure);
    }
    clock.tick();
    progress.show(queue, ending ? "ending: waits for the trials under way" : "");
  }
  progress.finish(queue);
  return queue.complete() ? EngineEnd::complete : EngineEnd::interrupted;
}

void run_in_turn(const TrialMaker& maker, const std::vector<std::int64_t>& trials,
                 const std::function<void(const TrialResult&)>& deliver) {
  TrialWorkers worker(maker, 1);
  for (const std::int64_t index : trials) {
    worker.start(index);
    while (!worker.idle()) {
      for (const TrialResult& result : worker.wait(kPatience, TrialWorkers::Lost::again)) {
        deliver(result);
      }
    }
  }
}

}  // namespace hopscotch::apps::campaign
