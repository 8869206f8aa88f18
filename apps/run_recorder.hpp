#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "apps/black_box.hpp"
#include "apps/lockstep_run.hpp"
#include "apps/run_folder.hpp"
#include "apps/run_result.hpp"
#include "core/operator_command.hpp"
#include "msgs/event.hpp"
#include "msgs/run_log.hpp"

namespace hopscotch::apps {

/// Texts that a run was made from, kept with it.
struct RunSources {
  std::string scenario;       ///< YAML of the scenario file.
  std::string configuration;  ///< YAML of `hopscotch.yaml`.
  std::string robot;          ///< YAML of the simulated robot.
};

/// Turns a run into events, writes them into a run folder and shows them to whoever listens.
/// Everything goes to `<folder>.partial` and takes its name at the end, so that a run folder is
/// whole or not there. When the disk refuses the log, the run goes on without it and says so.
class RunRecorder {
 public:
  using Listener = std::function<void(const msgs::Event&)>;

  /// @throws core::ConfigError if `folder` exists and is no run folder; std::runtime_error if the
  ///         disk refuses.
  RunRecorder(const std::filesystem::path& folder, std::uint64_t run_id, const RunRequest& request,
              const RunSources& sources);
  ~RunRecorder();
  RunRecorder(const RunRecorder&) = delete;
  RunRecorder& operator=(const RunRecorder&) = delete;

  /// From now on `listener` sees every event; the scene, which came first, at once.
  void add_listener(Listener listener);

  void record(const TickRecord& tick);
  /// A command of the operator as it arrived, and an answer that the pipeline does not know of.
  void record(core::Stamp now, const core::OperatorCommand& command);
  void record(core::Stamp now, const core::OperatorAnswer& answer);

  /// Writes the result and gives the folder its name; after a fall or fault with the last seconds
  /// of all channels but depth in a folder `black-box` of its own. @return the finished folder.
  RunFolder finish(const RunResult& result);

 private:
  static constexpr int kLongAgo = 1000;
  void write_sources(const RunRequest& request, const RunSources& sources) const;
  void write_black_box(const RunResult& result) const;
  void record_decision(core::Stamp now, const PipelineEvents& events);
  void record_perception(core::Stamp now, const PipelineEvents& events);
  void record_question(core::Stamp now, const PipelineEvents& events);
  void record_prior(core::Stamp now, const PipelineEvents& events);
  [[nodiscard]] bool motion_due(const TickRecord& tick);
  void put(const msgs::Event& event);
  void keep(const msgs::Event& event);
  void write(const msgs::Event& event);
  void close_log();
  template <typename Value>
  void put(core::Stamp now, const Value& value) {
    put(maker_.make(now, value));
  }

  std::filesystem::path folder_;
  bool log_depth_;
  RunFolder partial_;
  msgs::EventMaker maker_;
  msgs::RunLogWriter log_;
  bool log_broken_ = false;
  BlackBox black_box_;
  msgs::Event scene_;
  std::vector<Listener> listeners_;
  msgs::StageTimes times_;       ///< Since the last status.
  int since_record_ = kLongAgo;  ///< Of the motion [ticks].
  int since_change_ = kLongAgo;  ///< Of phase or contact [ticks].
  core::RobotPhase phase_ = core::RobotPhase::stand;
  std::array<bool, core::kLegs> contact_{};
  control::ContactExpectation expected_ = control::ContactExpectation::support;
  std::optional<double> told_height_;  ///< By the map, after the last tick [m].
  core::Stamp next_map_;               ///< No map is recorded before.
  core::Stamp next_refusal_;           ///< The same refusal is not repeated before.
  core::Reason refused_ = core::Reason::none;
  bool finished_ = false;
};

/// The same 64 bits for the same texts and seed: identifies a run.
[[nodiscard]] std::uint64_t run_identity(const RunSources& sources, const RunRequest& request);

}  // namespace hopscotch::apps
