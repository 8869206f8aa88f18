#pragma once

#include <filesystem>

#include "apps/campaign/trial_result.hpp"
#include "apps/campaign/trial_setup.hpp"

namespace hopscotch::apps::campaign {

/// So many repetitions of each cell keep the path of their CoM for the report.
inline constexpr std::int64_t kPathsPerCell = 100;

/// Runs a trial in this process; where the camera's run was refused also the same seed on true
/// terrain, which decides whether the refusal was right.
[[nodiscard]] TrialResult run_trial(const TrialMaker& maker, std::int64_t index);

/// The same with log, result and report in `folder`.
/// @return the run as recorded there.
RunResult record_trial(const TrialMaker& maker, std::int64_t index,
                       const std::filesystem::path& folder);

}  // namespace hopscotch::apps::campaign
