#include "apps/operator_desk.hpp"

#include <cmath>
#include <utility>

namespace hopscotch::apps {

using core::OperatorCommand;
using core::Reason;
using core::Refusal;

namespace {

bool is_a_place(const core::TargetOverride& target) {
  return std::isfinite(target.distance) && std::isfinite(target.lateral) &&
         std::isfinite(target.yaw) && !std::isinf(target.height);
}

}  // namespace

void OperatorDesk::set_mode(Mode mode) {
  mode_ = mode;
  if (mode == Mode::free && stage_ == Stage::promised) stage_ = Stage::released;
  if (mode == Mode::stopping) withdraw_target("the operator stopped the run");
}

void OperatorDesk::take_target(const OperatorCommand& command) {
  if (!is_a_place(*command.target)) {
    refuse(command, {Reason::target_malformed, "distance, lateral and yaw must be finite numbers"});
  } else if (mode_ == Mode::stopping) {
    refuse(command, {Reason::not_now, "the run is being stopped"});
  } else {
    if (target_ && stage_ != Stage::fresh) standing_ = std::exchange(target_, std::nullopt);
    if (target_) refuse(*target_, {Reason::withdrawn, "replaced by a newer target"});
    target_ = command;
    stage_ = Stage::fresh;
  }
}

/// An unanswered target is refused; one that was accepted while held just goes.
bool OperatorDesk::withdraw_target(const char* why) {
  standing_.reset();
  if (!target_) return false;
  if (stage_ == Stage::fresh) refuse(*target_, {Reason::withdrawn, why});
  target_.reset();
  return true;
}

std::optional<core::TargetOverride> OperatorDesk::due() const {
  return target_ && stage_ != Stage::promised ? target_->target : std::nullopt;
}

void OperatorDesk::refuse_target(const Refusal& refusal, double open_in) {
  if (!due()) return;
  Refusal why = refusal;
  if (standing_) why.sentence += "; the target accepted before stands";
  refuse(*target_, std::move(why), open_in);
  target_ = std::exchange(standing_, std::nullopt);
  stage_ = mode_ == Mode::held ? Stage::promised : Stage::released;
}

void OperatorDesk::accept_target(double start_in) {
  if (!due()) return;
  standing_.reset();
  if (check_only()) {
    accept(*target_, "the robot is held and jumps there after `hopscotch command jump`");
    stage_ = Stage::promised;
    return;
  }
  if (stage_ == Stage::fresh) {
    accept(*target_, start_in > 0.0 ? "it jumps once it has landed" : "it jumps now", start_in);
  }
  target_.reset();
}

void OperatorDesk::accept(const OperatorCommand& command, std::string_view remark,
                          double start_in) {
  if (command.sequence == 0) return;
  answers_.push_back(
      {.command = command, .refusal = {}, .start_in = start_in, .remark = std::string(remark)});
}

void OperatorDesk::refuse(const OperatorCommand& command, Refusal refusal, double open_in) {
  answers_.push_back(
      {.command = command, .refusal = std::move(refusal), .start_in = open_in, .remark = {}});
}

std::vector<core::OperatorAnswer> OperatorDesk::take_answers() {
  return std::exchange(answers_, {});
}

}  // namespace hopscotch::apps
