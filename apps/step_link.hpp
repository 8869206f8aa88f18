#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "core/time.hpp"

namespace hopscotch::apps {

/// Lock-step between `robot` and `motors` on one machine, over an abstract Unix socket: the robot
/// grants one exchange period, the world lives it and says the time. Nobody measures wall time, so
/// both may be as slow as they like. Frames and IMU messages travel on their own ways and are there
/// before the time is said.
class StepGranter {
 public:
  /// Waits for the other side to be there.
  /// @throws std::runtime_error if nobody listens within `patience` [s].
  StepGranter(const std::string& socket_name, double patience);
  ~StepGranter();
  StepGranter(const StepGranter&) = delete;
  StepGranter& operator=(const StepGranter&) = delete;

  /// Lets the world live one period. @return Its time; nothing if the other side has gone. No heap,
  /// no exception.
  std::optional<core::Stamp> grant() noexcept;

 private:
  int descriptor_;
};

/// The world's side. One robot after the other may come.
class StepFollower {
 public:
  /// @throws std::runtime_error if the name is taken.
  explicit StepFollower(const std::string& socket_name);
  ~StepFollower();
  StepFollower(const StepFollower&) = delete;
  StepFollower& operator=(const StepFollower&) = delete;

  enum class Event : std::uint8_t { none, granted, robot_gone };
  /// Waits for at most `timeout_ms` for a period to live, or for a robot to come.
  Event wait(int timeout_ms);
  /// The period has been lived.
  void done(core::Stamp now);

 private:
  int listener_;
  int robot_ = -1;
};

}  // namespace hopscotch::apps
