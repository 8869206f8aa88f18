#pragma once

#include <filesystem>

#include "apps/campaign/campaign.hpp"
#include "apps/campaign/engine.hpp"

namespace hopscotch::apps::campaign {

/// The machine or its cluster lacks what the engine needs.
class EngineError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// What a job of the cluster needs to call this program again.
struct SlurmRequest {
  std::filesystem::path spec;
  CampaignFolder folder;  ///< On a file system that all nodes share.
};

/// Runs what the queue holds as job arrays of Slurm, chunks of trials per element. Elements on
/// nodes that die are queued again by Slurm and go on where their predecessors were; elements that
/// fail are submitted again. A campaign that was left while its array runs finds it again.
/// @throws EngineError if Slurm is not there, does not answer, or runs nothing; std::runtime_error
///         if the store refuses; what was stored stays.
[[nodiscard]] EngineEnd run_slurm(const TrialMaker& maker, const SlurmRequest& request,
                                  Store& store, TrialQueue& queue);

}  // namespace hopscotch::apps::campaign
