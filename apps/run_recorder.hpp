#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "apps/lockstep_run.hpp"
#include "apps/run_folder.hpp"
#include "apps/run_result.hpp"
#include "msgs/run_log.hpp"

namespace hopscotch::apps {

/// Texts that a run was made from, kept with it.
struct RunSources {
  std::string scenario;       ///< YAML of the scenario file.
  std::string configuration;  ///< YAML of `hopscotch.yaml`.
  std::string robot;          ///< YAML of the simulated robot.
};

/// Writes a run folder. Everything goes to `<folder>.partial` and takes its name at the end, so
/// that a run folder is whole or not there.
class RunRecorder {
 public:
  /// @throws core::ConfigError if `folder` exists and is no run folder; std::runtime_error if the
  ///         disk refuses.
  RunRecorder(const std::filesystem::path& folder, std::uint64_t run_id, const RunRequest& request,
              const RunSources& sources);
  ~RunRecorder();
  RunRecorder(const RunRecorder&) = delete;
  RunRecorder& operator=(const RunRecorder&) = delete;

  void record(const TickRecord& tick);

  /// Writes the result and gives the folder its name. @return the finished folder.
  RunFolder finish(const RunResult& result);

 private:
  void write_sources(const RunRequest& request, const RunSources& sources) const;

  std::filesystem::path folder_;
  RunFolder partial_;
  msgs::RunLogWriter log_;
  msgs::StageTimes times_;  ///< Since the last status.
  std::int64_t ticks_ = 0;
  bool finished_ = false;
};

/// The same 64 bits for the same texts and seed: identifies a run.
[[nodiscard]] std::uint64_t run_identity(const RunSources& sources, const RunRequest& request);

}  // namespace hopscotch::apps
