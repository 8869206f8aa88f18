#include "apps/run_attendant.hpp"

#include <algorithm>

namespace hopscotch::apps {

void RunAttendant::attend(LockstepRun& run) {
  for (const core::OperatorCommand& command : box_.take_all()) {
    recorder_.record(run.now(), command);
    core::OperatorAnswer answer{
        .command = command, .refusal = gate_.check(command, wall_clock_us()), .remark = {}};
    if (answer.accepted()) {
      open_.push_back(command);
      run.apply(command);
    } else {
      recorder_.record(run.now(), answer);
    }
  }
}

void RunAttendant::note(const PipelineEvents& events) {
  for (const core::OperatorAnswer& answer : events.answers) {
    std::erase_if(open_, [&](const core::OperatorCommand& command) {
      return command.sequence == answer.command.sequence;
    });
  }
}

void RunAttendant::close(core::Stamp now) {
  const core::Refusal over{core::Reason::not_now, "the run is over"};
  for (const core::OperatorCommand& command : open_) {
    recorder_.record(now, core::OperatorAnswer{.command = command, .refusal = over, .remark = {}});
  }
  for (const core::OperatorCommand& command : box_.take_all()) {
    recorder_.record(now, command);
    recorder_.record(now, core::OperatorAnswer{.command = command, .refusal = over, .remark = {}});
  }
  open_.clear();
}

}  // namespace hopscotch::apps
