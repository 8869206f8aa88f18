#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "apps/campaign/spec.hpp"

namespace hopscotch::apps::campaign {

/// Which trials are still to be run. With a stop rule a cell is looked at only when a whole number
/// of batches of it is complete, so that the trials that are run in the end depend neither on the
/// number of workers nor on interruptions.
class TrialQueue {
 public:
  explicit TrialQueue(const CampaignSpec& spec);

  /// The next trial that nobody has yet; nothing while all that may be run is being run.
  std::optional<std::int64_t> next();

  /// A trial has its result, from this session or from an earlier one.
  enum class Verdict : std::uint8_t { success, failure };
  void finished(std::int64_t index, Verdict verdict);
  /// A trial was not finished after all and is to be run by somebody.
  void give_back(std::int64_t index);

  [[nodiscard]] bool complete() const { return finished_ == wanted_; }
  /// Trials that have a result, and those that are wanted as things stand.
  [[nodiscard]] std::int64_t finished_count() const { return finished_; }
  [[nodiscard]] std::int64_t wanted_count() const { return wanted_; }

 private:
  enum class State : std::uint8_t { open, running, success, failure };
  struct Cell {
    std::int64_t wanted = 0;    ///< Repetitions, as things stand.
    std::int64_t finished = 0;  ///< Of those.
    std::int64_t successes = 0;
  };
  void look_at(std::int64_t cell);
  void count(std::int64_t cell, State state);

  std::int64_t trials_;
  std::optional<StopRule> stop_;
  std::vector<Cell> cells_;
  std::vector<State> states_;  ///< By index.
  std::int64_t cursor_ = 0;    ///< No open wanted trial lies before.
  std::int64_t finished_ = 0;
  std::int64_t wanted_ = 0;
};

}  // namespace hopscotch::apps::campaign
