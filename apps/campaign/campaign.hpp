#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "apps/campaign/engine.hpp"
#include "apps/campaign/spec.hpp"

namespace hopscotch::apps::campaign {

/// Names of the files in a campaign's folder.
struct CampaignFolder {
  std::filesystem::path path;

  [[nodiscard]] std::filesystem::path store() const { return path / "trials.sqlite"; }
  [[nodiscard]] std::filesystem::path summary() const { return path / "summary.json"; }
  [[nodiscard]] std::filesystem::path report() const { return path / "report.html"; }
  [[nodiscard]] std::filesystem::path table() const { return path / "trials.csv"; }
  [[nodiscard]] std::filesystem::path cells() const { return path / "cells.csv"; }
  [[nodiscard]] std::filesystem::path comparison() const { return path / "comparison.json"; }
  [[nodiscard]] std::filesystem::path figures() const { return path / "figures"; }
  [[nodiscard]] std::filesystem::path lock() const { return path / "lock"; }
  /// Run folder of one trial.
  [[nodiscard]] std::filesystem::path run(std::int64_t index) const {
    return path / "runs" / ("trial-" + std::to_string(index));
  }
};

/// Holds a campaign's folder for one process at a time; a kill of any kind gives it free.
class FolderLock {
 public:
  /// @throws core::ConfigError if another process holds it.
  explicit FolderLock(const CampaignFolder& folder);
  ~FolderLock();
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

 private:
  int file_;
};

/// Tells the queue which trials the store has.
void skip_finished(const Store& store, TrialQueue& queue);

/// Writes run folders with logs of the first failures of each class and of the first successes,
/// in worker processes; those that are there stay.
void keep_runs(const TrialMaker& maker, int jobs, const CampaignFolder& folder, const Store& store);

/// Compares the campaign with another one on the same draws whenever its results are written.
/// @throws core::ConfigError if the folder holds no such campaign.
void compare_with(const std::filesystem::path& other, Store& store);

/// (Re)writes summary, tables, figures and report from the store alone.
void write_results(const CampaignFolder& folder);

}  // namespace hopscotch::apps::campaign
