#include "apps/robot_voice.hpp"

#include "hardware/robot_plant.hpp"

namespace hopscotch::apps {

using core::Reason;

void RobotVoice::tell(core::Stamp now, const RobotSession& session, const RobotBrain* brain) {
  tell_progress(now, session, brain);
  constexpr double kStatusEvery = 0.05;  // [s]
  if (now.since(told_) < kStatusEvery) return;
  told_ = now;
  tell_status(now, session, brain);
}

void RobotVoice::tell(core::Stamp now, const core::OperatorAnswer& said) {
  console_.say("robot: %.3f s: operator's %s: %s", now.seconds(),
               said.command.mode == core::ModeRequest::none
                   ? "target"
                   : std::string(core::mode_request_name(said.command.mode)).c_str(),
               said.accepted() ? "accepted" : said.refusal.text().c_str());
  live_.tell(now, ack_of(now, said));
}

void RobotVoice::tell_progress(core::Stamp now, const RobotSession& session,
                               const RobotBrain* brain) {
  const SessionStage stage = session.stage();
  if (stage != told_stage_) {
    const SessionFault& fault = session.fault();
    const bool failed = stage == SessionStage::stopping && fault.reason != Reason::stopped_by_user;
    console_.say("robot: %.3f s: %s%s", now.seconds(),
                 std::string(session_stage_name(stage)).c_str(),
                 failed ? (", fault " + fault_text(fault)).c_str() : "");
    told_stage_ = stage;
  }
  if (brain != nullptr && brain->jumps() != told_jumps_) {
    told_jumps_ = brain->jumps();
    if (told_jumps_ > 0) {
      console_.say("robot: %.3f s: jump %d has landed", now.seconds(), told_jumps_);
    }
  }
}

void RobotVoice::tell_status(core::Stamp now, const RobotSession& session,
                             const RobotBrain* brain) {
  msgs::Status status;
  if (brain != nullptr && brain->ticked()) status.control = brain->pipeline().status();
  status.control.stamp = now;
  if (session.stage() != SessionStage::active) {
    status.control.phase =
        session.fault().reason == Reason::none ? core::RobotPhase::damp : core::RobotPhase::fault;
  }
  status.control.fault = session.fault().reason;
  status.jump = told_jumps_;
  status.deadline_misses = static_cast<int>(session.deadlines().late);
  live_.tell(now, status);
}

std::string RobotVoice::fault_text(const SessionFault& fault) const {
  const std::string where = hardware::describe(fault.plant, topology_);
  return std::string(core::reason_code(fault.reason)) + (where.empty() ? "" : ": " + where) +
         ", in " + std::string(core::robot_phase_name(fault.phase));
}

}  // namespace hopscotch::apps
