#pragma once

#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "core/operator_command.hpp"

namespace hopscotch::apps {

/// What the operator has asked for and what has become of it: at most one landing target, which
/// overrides the next choice and no further one, and the answers. A target that is given while the
/// robot is held is checked at once and jumped to when it is released; should it be impossible by
/// then, it gets a second answer that says so. It stands until another one is accepted.
class OperatorDesk {
 public:
  enum class Mode : std::uint8_t { free, held, stopping };

  [[nodiscard]] Mode mode() const { return mode_; }
  void set_mode(Mode mode);

  /// A target to be judged, in place of an earlier one. Answers at once if it is no place or the
  /// run is being stopped. @pre command.target
  void take_target(const core::OperatorCommand& command);
  /// Drops the target. @return whether there was one.
  bool withdraw_target(const char* why);

  /// The target that the next choice has to take; none when it has been answered, or while held
  /// once it has been checked.
  [[nodiscard]] std::optional<core::TargetOverride> due() const;
  /// Whether the target that is due is only to be judged, because the robot is held.
  [[nodiscard]] bool check_only() const { return mode_ != Mode::free; }
  /// The target that was due cannot be.
  /// @param open_in Until it may be asked again [s]; NaN: it is not a matter of time.
  void refuse_target(const core::Refusal& refusal, double open_in = core::kNaN);
  /// The target that was due has been planned. @param start_in Until the jump starts [s].
  void accept_target(double start_in);

  /// @param start_in As in the answer. A command with the sequence number 0 is the program's own
  ///                 wish: nobody waits for its answer.
  void accept(const core::OperatorCommand& command, std::string_view remark,
              double start_in = core::kNaN);
  void refuse(const core::OperatorCommand& command, core::Refusal refusal,
              double open_in = core::kNaN);
  /// Answers since the last call, oldest first.
  [[nodiscard]] std::vector<core::OperatorAnswer> take_answers();

 private:
  /// Of the target: not judged yet; accepted while held and waiting; waiting no longer.
  enum class Stage : std::uint8_t { fresh, promised, released };

  Mode mode_ = Mode::free;
  std::optional<core::OperatorCommand> target_;    ///< Not yet jumped to.
  std::optional<core::OperatorCommand> standing_;  ///< Promised, while `target_` is fresh.
  Stage stage_ = Stage::fresh;
  std::vector<core::OperatorAnswer> answers_;
};

}  // namespace hopscotch::apps
