#pragma once

#include <condition_variable>
#include <mutex>
#include <optional>
#include <string>

#include "apps/lockstep_run.hpp"
#include "apps/program_config.hpp"
#include "apps/slope_planner.hpp"
#include "footstep/landing_selector.hpp"

namespace hopscotch::apps {

/// Tries targets out beside a run, without touching it: selector and planner of its own judge a
/// copy of what the run knows.
class ProposalDesk {
 public:
  ProposalDesk(const ProgramConfig& config, const model::RobotParameters& robot);

  /// From the loop of the run, every tick: hands over what the run knows when somebody asks.
  void serve(const LockstepRun& run);

  /// From any other thread. @param request `{"x": m, "y": m, "yaw": rad}`, a place in W.
  /// @return JSON with the place as a target, the verdict, and certificate and path of its plan.
  /// @throws std::invalid_argument on another request.
  [[nodiscard]] std::string propose(const std::string& request);

 private:
  [[nodiscard]] std::optional<DecisionView> wait_for_view();

  ProgramConfig config_;
  footstep::LandingSelector selector_;
  SlopePlanner planner_;
  std::mutex one_at_a_time_;  ///< Planner and selector have one user.
  std::mutex mutex_;
  std::condition_variable handed_over_;
  bool wanted_ = false;
  std::optional<DecisionView> view_;
};

}  // namespace hopscotch::apps
