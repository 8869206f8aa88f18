#include "apps/state_history.hpp"

#include <Eigen/Geometry>

#include "core/check.hpp"

namespace hopscotch::apps {

void StateHistory::add(const core::RobotState& state) {
  HOPSCOTCH_CHECK(count_ == 0 || from_oldest(count_ - 1).stamp < state.stamp);
  states_[next_] = state;
  next_ = (next_ + 1) % kCapacity;
  if (count_ < kCapacity) ++count_;
}

const core::RobotState& StateHistory::from_oldest(std::size_t i) const {
  return states_[(next_ + kCapacity - count_ + i) % kCapacity];
}

namespace {

core::RobotState interpolate(const core::RobotState& a, const core::RobotState& b,
                             core::Stamp stamp) {
  const double s = stamp.since(a.stamp) / b.stamp.since(a.stamp);
  core::RobotState state = s < 0.5 ? a : b;  // contacts of the nearer one
  state.stamp = stamp;
  state.p_WB = (1.0 - s) * a.p_WB + s * b.p_WB;
  const Eigen::Quaterniond from(a.R_WB);
  const Eigen::Quaterniond to(b.R_WB);
  state.R_WB = from.slerp(s, to).toRotationMatrix();
  state.v_WB = (1.0 - s) * a.v_WB + s * b.v_WB;
  state.w_WB = (1.0 - s) * a.w_WB + s * b.w_WB;
  state.q = (1.0 - s) * a.q + s * b.q;
  state.dq = (1.0 - s) * a.dq + s * b.dq;
  return state;
}

}  // namespace

std::optional<core::RobotState> StateHistory::at(core::Stamp stamp) const {
  if (count_ == 0 || stamp < from_oldest(0).stamp || stamp > from_oldest(count_ - 1).stamp) {
    return std::nullopt;
  }
  std::size_t low = 0;
  std::size_t high = count_ - 1;
  while (high - low > 1) {
    const std::size_t middle = (low + high) / 2;
    (from_oldest(middle).stamp <= stamp ? low : high) = middle;
  }
  if (from_oldest(high).stamp == stamp || low == high) return from_oldest(high);
  if (from_oldest(low).stamp == stamp) return from_oldest(low);
  return interpolate(from_oldest(low), from_oldest(high), stamp);
}

}  // namespace hopscotch::apps
