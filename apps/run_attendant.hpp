#pragma once

#include <cstdint>
#include <vector>

#include "apps/command_gate.hpp"
#include "apps/live_run.hpp"
#include "apps/lockstep_run.hpp"
#include "apps/run_recorder.hpp"

namespace hopscotch::apps {

/// Attends to the operator of one run: what arrives in the box is checked, recorded and handed to
/// the run; every command is answered, at the latest when the run ends.
class RunAttendant {
 public:
  /// @param recorder Outlives this object.
  RunAttendant(std::uint64_t run_id, RunRecorder& recorder)
      : gate_(run_id, wall_clock_us()), recorder_(recorder) {}

  /// Where commands are to be put.
  [[nodiscard]] CommandBox& box() { return box_; }

  /// Between ticks.
  void attend(LockstepRun& run);
  /// After each tick: notes which commands have been answered.
  void note(const PipelineEvents& events);
  /// The run is over.
  void close(core::Stamp now);

 private:
  CommandBox box_;
  CommandGate gate_;
  RunRecorder& recorder_;
  std::vector<core::OperatorCommand> open_;  ///< Not answered yet.
};

}  // namespace hopscotch::apps
