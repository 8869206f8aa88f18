#include "apps/motion_replay.hpp"

#include <cmath>

#include "apps/shipped_jumps.hpp"
#include "msgs/convert.hpp"

namespace hopscotch::apps {

namespace {

template <typename Value>
bool equal(const Value& a, const Value& b) {
  return msgs::encode(a, {}) == msgs::encode(b, {});
}

}  // namespace

MotionReplay::MotionReplay(const ProgramConfig& config, const model::RobotParameters& robot)
    : config_(config),
      robot_(robot),
      planner_(config.planner, robot, shipped_jumps(robot.name, config.planner.steps)) {}

void MotionReplay::prior(const msgs::EstimatorPrior& prior) {
  if (prior.start) {
    estimator_.emplace(config_.control.estimator, robot_,
                       control::StartPlace{prior.start->p_WS, prior.start->yaw});
  }
  if (estimator_ && !std::isnan(prior.height)) estimator_->correct_height(prior.height);
  expected_ = static_cast<control::ContactExpectation>(prior.expected);
}

void MotionReplay::sensors(const core::SensorReadings& readings) {
  if (estimator_) {
    estimator_->update(readings, expected_);
  } else {
    ++homeless_readings_;
  }
}

void MotionReplay::state(const core::RobotState& recorded) {
  if (!estimator_) return;  // the state came from elsewhere
  ++states_.compared;
  if (!equal(recorded, estimator_->state())) ++states_.differing;
}

void MotionReplay::question(const msgs::TargetQuestion& asked) {
  rest_ = asked.rest;
}

/// Terrain that could not be cleared as the target had it may have been planned over closer: the
/// plan holds the target that it was made for.
void MotionReplay::plan(const core::JumpPlan& recorded) {
  if (!rest_) return;
  const core::Result<core::JumpPlan> made = planner_.plan({.start = *rest_,
                                                           .target = recorded.target,
                                                           .final_posture = config_.stand_posture,
                                                           .id = recorded.id});
  ++plans_.compared;
  if (!made || !equal(recorded, *made)) ++plans_.differing;
}

}  // namespace hopscotch::apps
