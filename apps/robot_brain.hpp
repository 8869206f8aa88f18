#pragma once

#include <optional>
#include <utility>

#include "apps/pipeline.hpp"
#include "apps/robot_config.hpp"
#include "apps/robot_session.hpp"

namespace hopscotch::apps {

/// The whole pipeline for the robot's session: on ground that it sees, or on a floor that the
/// operator vouches for as level.
class RobotBrain {
 public:
  /// @param eyes Outlives this object; null: the floor is level.
  RobotBrain(const RobotConfig& config, core::DepthSource* eyes);

  /// Refers to this object.
  [[nodiscard]] SessionBrain session_brain();

  /// The pipeline has begun; the robot stands and is held until the operator lets it jump.
  [[nodiscard]] bool ticked() const { return ticked_; }
  /// @pre ticked()
  void apply(const core::OperatorCommand& command);
  [[nodiscard]] const Pipeline& pipeline() const { return pipeline_; }
  /// Why it did not jump when it was free to, once: it holds then, until the next `jump`.
  [[nodiscard]] std::optional<core::Refusal> take_refusal() {
    return std::exchange(refusal_, std::nullopt);
  }
  /// Landed so far.
  [[nodiscard]] int jumps() const { return jumps_; }

 private:
  /// On a floor that is known to be level.
  class NoCamera final : public core::DepthSource {
   public:
    std::optional<core::DepthFrame> poll(core::Stamp) override { return std::nullopt; }
  };

  core::JointCommand tick(const core::SensorReadings& readings);
  void hold();

  NoCamera nothing_;
  core::DepthSource& camera_;
  Pipeline pipeline_;
  bool ticked_ = false;
  core::RobotPhase phase_ = core::RobotPhase::stand;
  int jumps_ = 0;
  int jumps_per_command_;
  int jumps_left_ = 0;
  std::optional<core::Refusal> refusal_;
};

/// The posture that a stop in flight lands with: that of standing [rad].
/// @throws core::ConfigError if the robot cannot stand as configured.
[[nodiscard]] core::JointVector landing_posture(const RobotConfig& config);

}  // namespace hopscotch::apps
