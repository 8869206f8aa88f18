#include "sim/disturbance.hpp"

#include <algorithm>
#include <cmath>

namespace hopscotch::sim {
namespace {

std::int64_t ticks(double duration) {
  return std::llround(duration / kTick);
}

}  // namespace

void CommandDelay::send(std::int64_t now, const core::JointCommand& command) {
  under_way_.push_back({.arrival = now + delay_, .command = command});
}

const core::JointCommand& CommandDelay::in_force(std::int64_t now) {
  while (!under_way_.empty() && under_way_.front().arrival <= now) {
    in_force_ = under_way_.front().command;
    under_way_.pop_front();
  }
  return in_force_;
}

PushSchedule::PushSchedule(const std::vector<Push>& pushes) {
  for (const Push& push : pushes) {
    Scheduled scheduled{.push = push, .phases_to_wait = push.occurrence, .start = std::nullopt};
    if (!push.phase) scheduled.start = ticks(push.at);
    pushes_.push_back(scheduled);
  }
}

void PushSchedule::notify_phase(std::int64_t now, std::optional<core::JumpPhase> phase) {
  if (phase == phase_) return;
  phase_ = phase;
  for (Scheduled& scheduled : pushes_) {
    if (scheduled.start || !phase || scheduled.push.phase != phase) continue;
    if (--scheduled.phases_to_wait == 0) scheduled.start = now + ticks(scheduled.push.after);
  }
}

Eigen::Vector3d PushSchedule::force(std::int64_t now) const {
  Eigen::Vector3d total = Eigen::Vector3d::Zero();
  for (const Scheduled& scheduled : pushes_) {
    if (!scheduled.start) continue;
    const std::int64_t length = std::max<std::int64_t>(1, ticks(scheduled.push.duration));
    if (now < *scheduled.start || now >= *scheduled.start + length) continue;
    total += scheduled.push.impulse / (static_cast<double>(length) * kTick);
  }
  return total;
}

}  // namespace hopscotch::sim
