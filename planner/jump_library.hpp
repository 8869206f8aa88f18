#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "planner/known_jump.hpp"

namespace hopscotch::planner {

/// Solved jumps of one robot over distance, height and start state, compiled off line: starting
/// points for jumps that are hard to solve, and jumps to fall back on when none can be solved.
class JumpLibrary {
 public:
  /// Without jumps.
  JumpLibrary() = default;
  JumpLibrary(std::string robot, const StepCounts& steps)
      : robot_(std::move(robot)), steps_(steps) {}

  void add(KnownJump jump) { jumps_.push_back(std::move(jump)); }

  [[nodiscard]] const std::string& robot() const { return robot_; }
  [[nodiscard]] const StepCounts& steps() const { return steps_; }
  [[nodiscard]] const std::vector<KnownJump>& jumps() const { return jumps_; }

  /// The up to `count` jumps that are most like the one of the task, the best one first; none that
  /// differs by more than a grid of the library is apart.
  [[nodiscard]] std::vector<const KnownJump*> nearest(const PlanarTask& task,
                                                      std::size_t count) const;

  /// Were its jumps made of so many steps? An empty library fits all.
  [[nodiscard]] bool fits(const StepCounts& steps) const;

  /// As a file: solutions in single precision, multipliers with three digits; little-endian.
  [[nodiscard]] std::string bytes() const;
  /// @throws std::invalid_argument saying what is wrong with the file.
  [[nodiscard]] static JumpLibrary from_bytes(std::string_view bytes);

 private:
  std::string robot_;
  StepCounts steps_;
  std::vector<KnownJump> jumps_;
};

/// How unlike two jumps are: 1 is as much as a library's grid is apart.
[[nodiscard]] double unlikeness(const KnownJump& jump, const PlanarTask& task);

}  // namespace hopscotch::planner
