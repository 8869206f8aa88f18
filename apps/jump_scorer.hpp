#pragma once

#include <optional>
#include <vector>

#include "apps/run_result.hpp"
#include "core/control_status.hpp"
#include "core/jump_plan.hpp"
#include "model/robot_parameters.hpp"
#include "sim/judge.hpp"
#include "sim/plant_truth.hpp"
#include "sim/terrain.hpp"

namespace hopscotch::apps {

/// Keeps the record of each jump, judged by the plant's truth.
class JumpScorer {
 public:
  /// @param robot   As simulated.
  /// @param terrain The true one.
  JumpScorer(const model::RobotParameters& robot, const sim::Terrain& terrain);

  /// To be called every tick. @param used The state that the controller worked on.
  /// @param plan The one being executed.
  void update(const sim::PlantTruth& truth, const core::RobotState& used,
              const core::ControlStatus& status, const core::JumpPlan& plan);

  /// What is left of the jump under way was planned anew.
  void replanned();

  /// The robot fell: ends the jump under way, if there is one.
  void fell(const core::Refusal& reason);

  /// Ends the record; the last jump is judged as the robot stands now.
  void finish(const sim::PlantTruth& truth);

  [[nodiscard]] const std::vector<JumpResult>& jumps() const { return jumps_; }

 private:
  void begin(const sim::PlantTruth& truth, const core::JumpPlan& plan);
  void follow(const sim::PlantTruth& truth, const core::RobotState& used);
  void compare_pitch(const core::RobotState& truth);
  void judge(const sim::PlantTruth& truth);

  model::RobotParameters robot_;
  sim::Terrain terrain_;
  std::vector<JumpResult> jumps_;
  core::RobotPhase phase_ = core::RobotPhase::stand;
  bool open_ = false;  ///< The last jump has not been judged.
  sim::TakeoffPlace takeoff_{};
  sim::LoadPeaks peaks_;
  core::JumpPlan plan_;  ///< As it was when the jump began: landings reshape the one they follow.
  std::optional<core::Stamp> liftoff_;
  std::optional<core::Stamp> touchdown_;
};

}  // namespace hopscotch::apps
