#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include "core/robot_state.hpp"

namespace hopscotch::apps {

/// The recent past of the robot's state, so that a depth frame is laid over the pose of its
/// exposure.
class StateHistory {
 public:
  /// States must come in order of time.
  void add(const core::RobotState& state);

  /// The state at `stamp`, interpolated between its neighbours; nothing outside of what is stored.
  [[nodiscard]] std::optional<core::RobotState> at(core::Stamp stamp) const;

 private:
  static constexpr std::size_t kCapacity = 512;  // half a second at 1 kHz
  [[nodiscard]] const core::RobotState& from_oldest(std::size_t i) const;

  std::array<core::RobotState, kCapacity> states_;
  std::size_t count_ = 0;
  std::size_t next_ = 0;
};

}  // namespace hopscotch::apps
