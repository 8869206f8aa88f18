#include "control/delay_estimator.hpp"

#include <algorithm>

namespace hopscotch::control {

namespace {

constexpr std::size_t kSamplesMin = 250;  // a quarter of a second at 1 kHz
/// Twice the logarithm of how much likelier the best candidate must be than any other.
constexpr double kClear = 60.0;
/// Motors at their limits do not give what they are asked for.
constexpr double kFarOff = 15.0;  // [N·m]

core::JointVector demand(const core::JointCommand& command, const core::SensorReadings& readings) {
  return command.tau + command.kp.cwiseProduct(command.q - readings.q) +
         command.kd.cwiseProduct(command.dq - readings.dq);
}

}  // namespace

const core::JointCommand& DelayEstimator::command_before(std::size_t exchanges) const noexcept {
  return commands_[(sent_ - 1 - exchanges) % kMemory];
}

void DelayEstimator::received(const core::SensorReadings& readings) noexcept {
  const bool follows = sent_ > kMemory && last_.stamp == command_before(0).stamp &&
                       command_before(kCandidates - 1).mode == core::DriveMode::active;
  if (follows && readings.tau.allFinite() && last_.q.allFinite()) {
    period_ = readings.stamp.since(last_.stamp);
    ++samples_;
    for (std::size_t k = 0; k < kCandidates; ++k) {
      // The torque of the last step was made at the reading before it.
      const core::JointVector missing = demand(command_before(k), last_) - readings.tau;
      squares_[k] += missing.cwiseMin(kFarOff).cwiseMax(-kFarOff).squaredNorm();
    }
  }
  last_ = readings;
}

void DelayEstimator::sent(const core::JointCommand& command) noexcept {
  commands_[sent_ % kMemory] = command;
  ++sent_;
}

std::optional<double> DelayEstimator::delay() const noexcept {
  if (samples_ < kSamplesMin) return std::nullopt;
  const auto best = std::min_element(squares_.begin(), squares_.end());
  const double variance = *best / static_cast<double>(samples_ * core::kJoints);
  for (auto other = squares_.begin(); other != squares_.end(); ++other) {
    if (other != best && *other - *best < kClear * variance) return std::nullopt;
  }
  return static_cast<double>(best - squares_.begin()) * period_;
}

}  // namespace hopscotch::control
