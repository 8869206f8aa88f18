#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "apps/campaign/store.hpp"
#include "apps/campaign/trial_queue.hpp"
#include "apps/campaign/trial_setup.hpp"
#include "apps/stopwatch.hpp"

namespace hopscotch::apps::campaign {

/// How an engine came back.
enum class EngineEnd : std::uint8_t { complete, interrupted };

/// Listens to Ctrl-C and SIGTERM while it lives: once asks to end cleanly, twice to end at once.
class Interrupts {
 public:
  Interrupts();
  ~Interrupts();
  Interrupts(const Interrupts&) = delete;
  Interrupts& operator=(const Interrupts&) = delete;

  [[nodiscard]] static int count();
};

/// Tells how far a campaign is: a line that rewrites itself on a terminal, else a line every 10 s.
class Progress {
 public:
  explicit Progress(const TrialQueue& queue);
  /// @param note What else to say, e.g. how many are being run.
  void show(const TrialQueue& queue, const std::string& note);
  /// Ends the line on a terminal.
  void finish(const TrialQueue& queue);

 private:
  [[nodiscard]] std::string line(const TrialQueue& queue, const std::string& note) const;
  Stopwatch watch_;
  std::int64_t at_start_;  ///< Finished before this session.
  double shown_ = -1e9;    ///< [s] of the watch
  bool terminal_;
};

/// Adds the computing time of a session to its store now and then, so that a kill loses little.
class Stopclock {
 public:
  explicit Stopclock(Store& store) : store_(store) {}
  ~Stopclock();
  Stopclock(const Stopclock&) = delete;
  Stopclock& operator=(const Stopclock&) = delete;
  void tick();

 private:
  Store& store_;
  Stopwatch watch_;
  double saved_ = 0.0;  ///< [s]
};

/// Runs what the queue holds in worker processes on this machine; each result is stored as it
/// comes. A worker that dies is tried again, since it may have been killed; after `kCrashes` times
/// the crash is the trial's result, after `kHangs` time limits the hang is.
/// @throws std::runtime_error if the store refuses; what was stored stays.
inline constexpr int kCrashes = 3;
inline constexpr int kHangs = 2;
[[nodiscard]] EngineEnd run_local(const TrialMaker& maker, int jobs, Store& store,
                                  TrialQueue& queue);

/// Runs trials one after another in a worker process with the same patience, and delivers each
/// result as it comes.
void run_in_turn(const TrialMaker& maker, const std::vector<std::int64_t>& trials,
                 const std::function<void(const TrialResult&)>& deliver);

}  // namespace hopscotch::apps::campaign
