#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "apps/campaign/factor.hpp"
#include "apps/campaign/family.hpp"
#include "apps/lockstep_run.hpp"
#include "core/ablation.hpp"
#include "sim/scenario.hpp"

namespace hopscotch::apps::campaign {

/// Ends a cell before all its trials once its rate is known well enough.
struct StopRule {
  double half_width = 0.02;  ///< Of the 95 % Wilson interval.
  int at_least = 100;        ///< Trials of a cell before it is looked at, and between looks.
};

/// Which trials get a run folder with log and report.
struct KeepRule {
  int failures = 2;  ///< Of each failure class, the first ones.
  int successes = 1;
};

/// A campaign file, checked.
struct CampaignSpec {
  std::string name;
  std::vector<sim::Scenario> bases;  ///< Of scenario files; several are levels of a factor
                                     ///< "scenario". Empty: `family` makes the terrain.
  FamilySpec family;
  std::string scenario_name;  ///< Family, or name of the scenario file.
  Eyes eyes = Eyes::camera;
  StateSource state = StateSource::estimate;
  core::Ablation ablation = core::Ablation::none;
  int trials = 0;  ///< Per cell.
  std::uint64_t seed = 1;
  std::vector<Factor> factors;  ///< Of the family first, then of `vary`, in the file's order.
  std::optional<StopRule> stop;
  KeepRule keep;
  double trial_timeout = 300.0;  ///< Wall time of one trial before it counts as hung [s].
  std::string source;            ///< The file's text.

  [[nodiscard]] std::int64_t cells() const;
  /// What all draws depend on. Campaigns that agree in it can be compared trial by trial.
  [[nodiscard]] std::string pairing() const;

  /// A scenario file is looked for beside the campaign file, then in the working folder.
  /// @throws core::ConfigError with file, line, key, value and the broken rule.
  static CampaignSpec load(const std::filesystem::path& file);
  static CampaignSpec from_text(std::string_view text, const std::filesystem::path& file);
};

/// A trial's place: `index` = repetition * cells + cell, so that more repetitions renumber nothing
/// and any beginning of a campaign is balanced over its cells.
struct TrialPlace {
  std::int64_t cell = 0;
  std::int64_t repetition = 0;
};
[[nodiscard]] inline TrialPlace place_of(std::int64_t index, std::int64_t cells) {
  return {index % cells, index / cells};
}

}  // namespace hopscotch::apps::campaign
