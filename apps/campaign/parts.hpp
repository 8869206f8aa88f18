#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "apps/campaign/store.hpp"
#include "apps/campaign/trial_setup.hpp"

namespace hopscotch::apps::campaign {

/// Results on their way from the nodes of a cluster: each attempt at a chunk of trials appends
/// lines to a file of its own, so that nobody shares a file, whatever is started twice; what a
/// killed attempt wrote counts.
struct PartsFolder {
  std::filesystem::path path;

  [[nodiscard]] std::filesystem::path chunk(int round, int chunk) const;
  /// Lists the trials of each chunk of a round.
  void write_round(int round, const std::vector<std::vector<std::int64_t>>& chunks) const;
  [[nodiscard]] std::vector<std::int64_t> read_chunk(int round, int chunk) const;
};

/// Runs the trials of one chunk that no earlier attempt has finished; for the job of a cluster.
/// @param name "ROUND/CHUNK".
/// @throws core::ConfigError if there is no such chunk.
void run_chunk(const TrialMaker& maker, const PartsFolder& folder, const std::string& name);

/// Reads part files as they grow.
class PartsReader {
 public:
  PartsReader(PartsFolder folder, StoreIdentity identity)
      : folder_(std::move(folder)), identity_(std::move(identity)) {}

  /// Gives every whole line that has come since the last call.
  /// @throws core::ConfigError if a part is of another campaign or program.
  void read_new(const std::function<void(const TrialResult&)>& visit);

 private:
  PartsFolder folder_;
  StoreIdentity identity_;
  std::map<std::filesystem::path, std::uintmax_t> read_;  ///< Bytes of each file.
};

}  // namespace hopscotch::apps::campaign
