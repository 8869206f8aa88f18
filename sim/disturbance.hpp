#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "core/joint_command.hpp"
#include "core/jump_plan.hpp"
#include "sim/scenario.hpp"

namespace hopscotch::sim {

/// Length of one step of the plant and of one exchange [s].
inline constexpr double kTick = 0.001;

/// Delays set-points by whole ticks: what is sent in tick k acts from tick k + delay on, until the
/// next one arrives. Before the first arrival the drives are idle.
class CommandDelay {
 public:
  /// @pre ticks >= 0
  explicit CommandDelay(int ticks) : delay_(ticks) {}

  /// Sends `command` in tick `now`.
  void send(std::int64_t now, const core::JointCommand& command);
  /// The set-points in force in tick `now`; `now` must not go back.
  [[nodiscard]] const core::JointCommand& in_force(std::int64_t now);

 private:
  struct Sent {
    std::int64_t arrival;
    core::JointCommand command;
  };
  std::int64_t delay_;
  std::deque<Sent> under_way_;
  core::JointCommand in_force_;
};

/// The scenario's pushes over time. Each acts once, with constant force over whole ticks, so that
/// its impulse is exact.
class PushSchedule {
 public:
  explicit PushSchedule(const std::vector<Push>& pushes);

  /// Tells which phase the controller is in from tick `now` on; nothing = it stands.
  void notify_phase(std::int64_t now, std::optional<core::JumpPhase> phase);
  /// Force at the trunk's CoM during tick `now`, in W [N].
  [[nodiscard]] Eigen::Vector3d force(std::int64_t now) const;

 private:
  struct Scheduled {
    Push push;
    int phases_to_wait;                 // occurrences of the phase still to come
    std::optional<std::int64_t> start;  // first tick, once it is known
  };
  std::vector<Scheduled> pushes_;
  std::optional<core::JumpPhase> phase_;
};

}  // namespace hopscotch::sim
