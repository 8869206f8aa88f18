#pragma once

#include <string>

#include "apps/console.hpp"
#include "apps/live_run.hpp"
#include "apps/robot_brain.hpp"
#include "apps/robot_session.hpp"
#include "core/time.hpp"
#include "hardware/bus_topology.hpp"

namespace hopscotch::apps {

/// What `robot` tells of itself after each exchange: stages and landings as lines for people, its
/// status over LCM twenty times a second. Both leave by threads of their own; the loop gives plain
/// values away and takes nothing from the heap for it, but for the sentence of a fault or refusal.
class RobotVoice {
 public:
  /// All outlive this object.
  RobotVoice(const hardware::BusTopology& topology, Console& console, LiveRun& live)
      : topology_(topology), console_(console), live_(live) {}

  /// @param brain Null before the first enabling.
  void tell(core::Stamp now, const RobotSession& session, const RobotBrain* brain);
  /// The answer to a command of the operator.
  void tell(core::Stamp now, const core::OperatorAnswer& said);

 private:
  void tell_progress(core::Stamp now, const RobotSession& session, const RobotBrain* brain);
  void tell_status(core::Stamp now, const RobotSession& session, const RobotBrain* brain);
  [[nodiscard]] std::string fault_text(const SessionFault& fault) const;

  const hardware::BusTopology& topology_;
  Console& console_;
  LiveRun& live_;
  core::Stamp told_;  ///< Last status.
  SessionStage told_stage_ = SessionStage::off;
  int told_jumps_ = 0;
};

}  // namespace hopscotch::apps
