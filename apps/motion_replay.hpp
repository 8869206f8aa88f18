#pragma once

#include <optional>

#include "apps/program_config.hpp"
#include "apps/slope_planner.hpp"
#include "control/state_estimator.hpp"
#include "core/jump_plan.hpp"
#include "core/robot_state.hpp"
#include "core/sensor_readings.hpp"
#include "model/robot_parameters.hpp"
#include "msgs/messages.hpp"

namespace hopscotch::apps {

/// How often something came out as it had been recorded.
struct Agreement {
  int compared = 0;
  int differing = 0;
};

/// Estimator and planner of a recorded run, run again on what they took in. What comes out is
/// compared with the record bit by bit, as far as the record goes: states and motions in 32-bit
/// numbers. Takes the messages of a log in their order.
class MotionReplay {
 public:
  MotionReplay(const ProgramConfig& config, const model::RobotParameters& robot);

  void prior(const msgs::EstimatorPrior& prior);
  void sensors(const core::SensorReadings& readings);
  void state(const core::RobotState& recorded);

  void question(const msgs::TargetQuestion& asked);
  void plan(const core::JumpPlan& recorded);

  /// Readings of a robot that the log does not say how it was put down.
  [[nodiscard]] int homeless_readings() const { return homeless_readings_; }
  [[nodiscard]] const Agreement& states() const { return states_; }
  [[nodiscard]] const Agreement& plans() const { return plans_; }

 private:
  const ProgramConfig& config_;
  const model::RobotParameters& robot_;
  std::optional<control::StateEstimator> estimator_;  ///< Until the robot is put down: none.
  control::ContactExpectation expected_ = control::ContactExpectation::support;
  SlopePlanner planner_;
  std::optional<core::RobotState> rest_;  ///< The stance of the last question.
  int homeless_readings_ = 0;
  Agreement states_;
  Agreement plans_;
};

}  // namespace hopscotch::apps
