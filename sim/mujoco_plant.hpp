#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "core/jump_plan.hpp"
#include "core/plant.hpp"
#include "core/reason.hpp"
#include "model/robot_parameters.hpp"
#include "sim/plant_truth.hpp"
#include "sim/scenario.hpp"

namespace hopscotch::sim {

/// How the robot stands when it is put down.
struct StartPosture {
  core::JointVector q = core::JointVector::Zero();  ///< [rad]
  double trunk_pitch = 0.0;                         ///< + = nose down [rad].
};

/// How far the real start is from the ideal one: uniform in +- these, drawn from the seed.
struct StartVariation {
  double joint = 0.03;     ///< Every joint [rad].
  double velocity = 0.05;  ///< Every component of the trunk's velocity [m/s].

  static constexpr StartVariation none() { return {.joint = 0.0, .velocity = 0.0}; }
};

struct PlantOptions {
  Scenario scenario;
  model::RobotParameters robot;  ///< Of `scenario.plant.robot`; its masses are scaled here.
  StartPosture posture;
  StartVariation variation;
  std::uint64_t seed = 0;  ///< Of start variation and sensor errors.
};

/// HECTOR on the scenario's true terrain in MuJoCo, 1 ms per exchange. Between a command and the
/// joints lie the latency in whole ticks, the drives' own PD at their own encoders, and the limits
/// of each motor; joint torques and the scenario's pushes are all that acts on the robot. At an
/// exchange period of 2 every second call passes the command on and brings new readings; the others
/// return the previous ones with their old stamp.
class MujocoPlant final : public core::Plant {
 public:
  /// Puts the robot down with the mid-point of its soles at the start place, its lowest toe or heel
  /// touching the ground, or `drop` above it.
  /// @throws std::runtime_error if MuJoCo refuses the scene.
  explicit MujocoPlant(const PlantOptions& options);
  ~MujocoPlant() override;
  MujocoPlant(const MujocoPlant&) = delete;
  MujocoPlant& operator=(const MujocoPlant&) = delete;

  /// Steps the world by one tick. After a fault nothing moves any more and the readings stay.
  core::SensorReadings exchange(const core::JointCommand& command) override;

  /// Tells the pushes which phase the controller is in from now on; nothing = it stands. Telling
  /// the same phase again changes nothing.
  void notify_phase(std::optional<core::JumpPhase> phase);

  [[nodiscard]] core::Stamp now() const;
  [[nodiscard]] PlantTruth truth() const;

  /// MuJoCo's first warning or non-finite number, in words; nothing while all is well.
  [[nodiscard]] std::optional<core::Refusal> fault() const;

 private:
  struct World;
  std::unique_ptr<World> world_;
};

}  // namespace hopscotch::sim
