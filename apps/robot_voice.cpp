#include "apps/robot_voice.hpp"

#include <array>
#include <cstdio>
#include <string>
#include <string_view>

#include "hardware/bus_topology.hpp"

namespace hopscotch::apps {

using core::Reason;

namespace {

/// A fault as the loop gives it away.
struct FaultFacts {
  const RobotConfig* config = nullptr;
  core::Stamp now;
  SessionFault fault;
};

std::string fault_words(const FaultFacts& facts) {
  const SessionFault& fault = facts.fault;
  const std::string where = hardware::describe(fault.plant, facts.config->topology);
  std::array<char, 64> head{};
  std::snprintf(head.data(), head.size(), "robot: %.3f s: stopping, fault ", facts.now.seconds());
  return head.data() + std::string(core::reason_code(fault.reason)) +
         (where.empty() ? "" : ": " + where) + ", in " +
         std::string(core::robot_phase_name(fault.phase));
}

/// All joints as the loop gives them away.
struct JointFacts {
  const RobotConfig* config = nullptr;
  SessionStage stage = SessionStage::off;
  Reason fault = Reason::none;
  std::array<double, core::kJoints> q{};            // [rad]
  std::array<double, core::kJoints> temperature{};  // [degC]
  std::array<bool, core::kJoints> heard{};
};

std::string joint_words(const JointFacts& facts) {
  std::string table;
  core::JointVector q;
  for (std::size_t i = 0; i < facts.q.size(); ++i) {
    const int joint = static_cast<int>(i);
    q[joint] = facts.q[i];
    std::array<char, 96> row{};
    std::snprintf(row.data(), row.size(), "  %-16s %+8.4f rad  %5.1f degC  %s\n",
                  hardware::joint_name(joint).c_str(), facts.q[i], facts.temperature[i],
                  facts.heard[i] ? "answers" : "does not answer");
    table += row.data();
  }
  const std::string obstacle = enabling_obstacle(*facts.config, facts.stage, facts.fault, q);
  return table + "  " + (obstacle.empty() ? "home: could be enabled" : obstacle);
}

}  // namespace

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
    if (failed) {
      console_.tell<fault_words>(FaultFacts{&config_, now, fault});
    } else {
      console_.say("robot: %.3f s: %s", now.seconds(),
                   std::string(session_stage_name(stage)).c_str());
    }
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

void RobotVoice::tell_joints(core::Stamp now, const RobotSession& session,
                             const hardware::RobotPlant& plant) {
  constexpr double kTableEvery = 1.0;  // [s]
  if (now.since(told_joints_) < kTableEvery) return;
  told_joints_ = now;
  JointFacts facts{.config = &config_, .stage = session.stage(), .fault = session.fault().reason};
  for (std::size_t i = 0; i < facts.q.size(); ++i) {
    facts.q[i] = session.readings().q[static_cast<int>(i)];
    facts.temperature[i] = plant.drives()[i].temperature_degC;
    facts.heard[i] = plant.drives()[i].heard;
  }
  console_.tell<joint_words>(facts);
}

void RobotVoice::tell_refusal(core::Stamp now, const core::Refusal& refusal) {
  const std::string_view code = core::reason_code(refusal.reason);
  console_.say("robot: %.3f s: no jump: %.*s%s%s; it holds", now.seconds(),
               static_cast<int>(code.size()), code.data(), refusal.sentence.empty() ? "" : ": ",
               refusal.sentence.c_str());
}

}  // namespace hopscotch::apps
