#include <algorithm>
#include <cmath>
#include <string>

#include "apps/pipeline.hpp"
#include "core/check.hpp"
#include "perception/one_step.hpp"

namespace hopscotch::apps {

using core::ModeRequest;
using core::Reason;
using core::RobotPhase;
using Mode = OperatorDesk::Mode;

void Pipeline::apply(const core::OperatorCommand& command) {
  HOPSCOTCH_CHECK(control_.has_value());
  const bool over = end_ && *end_ != MissionEnd::fault;
  const bool fault = control_->status().fault != Reason::none;
  const bool for_limp =
      command.mode == ModeRequest::clear_fault || command.mode == ModeRequest::damp;
  if (over) {
    desk_.refuse(command, {Reason::not_now, "the run is over"});
  } else if (fault && !for_limp) {
    desk_.refuse(command,
                 {Reason::not_now, "a fault is latched: " +
                                       std::string(core::reason_code(control_->status().fault))});
  } else if (command.mode != ModeRequest::none) {
    apply_mode(command);
  } else {
    apply_target(command);
  }
}

void Pipeline::reopen() {
  HOPSCOTCH_CHECK(end_ == MissionEnd::refused);
  end_.reset();
  end_reason_ = {};
  refused_since_.reset();
  failed_distances_.clear();
  called_off_ = 0;
  task_.target.reset();
}

std::optional<DecisionView> Pipeline::decision_view() const {
  if (!control_) return std::nullopt;
  const RobotPhase phase = control_->phase();
  if (!core::is_standing(phase) && phase != RobotPhase::landing) return std::nullopt;
  DecisionView view;
  view.rest = control_->rest_state();
  view.map = oracle_ ? oracle_(view.rest)() : *map_;
  view.hanging = hanging_;
  const perception::OneStepConfig& one_step = config_.perception.one_step;
  view.terrain = perception::one_step_terrain(one_step, view.map,
                                              perception::stance_pose(one_step, robot_, view.rest));
  return view;
}

/// From take-off to touchdown a jump goes where it was planned to.
bool Pipeline::is_locked() const {
  const RobotPhase phase = control_->phase();
  const bool under_way = core::is_pushing_off(phase) || phase == RobotPhase::flight;
  return under_way && control_->plan().id != 0;  // neither a fall nor a recovery hop
}

/// The operator chose a place as seen from where the robot stood: after the jump that is another
/// one.
void Pipeline::refuse_if_locked() {
  if (!desk_.due() || !is_locked()) return;
  decision_.drop();
  const core::ControlStatus& status = control_->status();
  const double open_in = std::max(0.0, control_->plan().touchdown_time - status.plan_time);
  desk_.refuse_target({Reason::not_now,
                       "the jump under way is locked until it has landed; until it rises "
                       "`hopscotch command hold` calls it off"},
                      open_in);
}

/// What has not taken off makes way for a newer wish.
void Pipeline::apply_target(const core::OperatorCommand& command) {
  if (command.target) {
    if (core::is_limp(control_->phase())) {
      desk_.refuse(command, {Reason::not_now, "the drives are off: `hopscotch command enable`"});
      return;
    }
    desk_.take_target(command);
    if (desk_.due()) decision_.drop();
  } else if (command.clear_target) {
    if (desk_.due()) decision_.drop();
    const bool dropped = desk_.withdraw_target("cleared by the operator");
    desk_.accept(command, dropped ? "the target is dropped" : "there was no target to drop");
  } else {
    desk_.refuse(command, {Reason::target_malformed, "the command asks for nothing"});
  }
}

void Pipeline::apply_mode(const core::OperatorCommand& command) {
  const bool limp = core::is_limp(control_->phase());
  const auto refuse = [&] {
    desk_.refuse(command, {Reason::not_now, "the drives are off: `hopscotch command enable`"});
  };
  switch (command.mode) {
    case ModeRequest::enable: enable(command); break;
    case ModeRequest::jump:
      if (limp) return refuse();
      static_cast<void>(control_->release());  // refused where nothing holds it
      desk_.set_mode(Mode::free);
      if (std::isfinite(command.goal_x)) mission_.goal_x = task_.goal_x = command.goal_x;
      desk_.accept(command, "the robot jumps on by itself");
      break;
    case ModeRequest::hold:
    case ModeRequest::stop: {
      if (!control_->hold() && control_->phase() != RobotPhase::hold) {
        return refuse();
      }
      decision_.drop();
      const bool stop = command.mode == ModeRequest::stop;
      desk_.set_mode(stop ? Mode::stopping : Mode::held);
      desk_.accept(command, stop ? "the robot comes to a stand and the run ends"
                                 : "the robot comes to a stand and waits");
      break;
    }
    case ModeRequest::damp:
      if (!control_->damp() && !limp) {
        return desk_.refuse(command, {Reason::not_now, "not in this phase"});
      }
      decision_.drop();
      desk_.withdraw_target("the operator damped the robot");
      desk_.set_mode(Mode::held);
      desk_.accept(command, "the drives only brake from now on");
      break;
    case ModeRequest::clear_fault: clear_fault(command); break;
    case ModeRequest::none: break;
  }
}

/// On from damping into standing still: jumping takes a second command.
void Pipeline::enable(const core::OperatorCommand& command) {
  if (!core::is_limp(control_->phase())) {
    desk_.accept(command, "the drives are on already");
  } else if (control_->release() && control_->hold()) {
    desk_.set_mode(Mode::held);
    desk_.accept(command, "the robot stands up and waits for `hopscotch command jump`");
  } else {
    desk_.refuse(command, {Reason::not_now, "the robot is not upright with its joints in range"});
  }
}

void Pipeline::clear_fault(const core::OperatorCommand& command) {
  if (!control_->clear_fault()) {
    desk_.refuse(command, {Reason::not_now, "no fault is latched"});
    return;
  }
  end_.reset();
  end_reason_ = {};
  desk_.set_mode(Mode::held);
  desk_.accept(command, "the drives stay limp until `hopscotch command enable`");
}

}  // namespace hopscotch::apps
