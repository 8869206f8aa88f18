#pragma once

#include <cstdint>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include "apps/campaign/spec.hpp"
#include "apps/lockstep_run.hpp"
#include "apps/run_recorder.hpp"

namespace hopscotch::apps::campaign {

/// Everything that makes up one trial.
struct TrialSetup {
  std::int64_t index = 0;
  std::uint64_t seed = 0;  ///< Of the run: noise and start variation.
  sim::Scenario scenario;
  std::string scenario_text;        ///< The scenario as a file.
  double jump_length = core::kNaN;  ///< Wanted; NaN: as configured [m].
  core::Ablation ablation = core::Ablation::none;
  /// Of each factor of the campaign, in its order. A factor that is drawn for each tread is told
  /// by its hardest draw: the largest by magnitude, the shortest of a tread. NaN: not used here.
  std::vector<double> values;
};

/// Makes trials from a campaign file; loads tuning and robots once, so that a worker that is
/// forked afterwards reads no file.
class TrialMaker {
 public:
  /// @throws core::ConfigError if the campaign cannot make a valid scenario, naming why.
  explicit TrialMaker(const CampaignSpec& spec);

  /// The trial of an index below cells * trials; the same one on every machine.
  /// @throws core::ConfigError if its draws make no valid scenario.
  [[nodiscard]] TrialSetup setup(std::int64_t index) const;

  /// The run of a trial, with the eyes asked for.
  [[nodiscard]] RunRequest request(const TrialSetup& setup, Eyes eyes) const;
  /// Texts that the run is made from.
  [[nodiscard]] RunSources sources(const TrialSetup& setup) const;

  [[nodiscard]] const CampaignSpec& spec() const { return spec_; }
  /// Fingerprint of all that decides how a trial ends but the program: draws, tuning, robots,
  /// perception, state, ablation. The number of trials is not part of it.
  [[nodiscard]] std::string identity() const;

 private:
  struct Robot {
    std::string text;
    model::RobotParameters parameters;
  };
  void check_cells() const;

  CampaignSpec spec_;
  std::string config_text_;
  ProgramConfig config_;
  std::map<std::string, Robot> robots_;
};

}  // namespace hopscotch::apps::campaign
