#pragma once

#include <array>
#include <cstdint>

#include "control/estimator_config.hpp"
#include "core/robot_state.hpp"
#include "core/sensor_readings.hpp"
#include "model/robot_parameters.hpp"

namespace hopscotch::control {

/// What the controller expects of the feet now: the prior of contact detection.
enum class ContactExpectation : std::uint8_t {
  support,    ///< Both bear load, or nothing is known.
  leaving,    ///< About to lift off.
  airborne,   ///< Flight, too early to touch down.
  touchdown,  ///< Flight, touchdown due.
};

/// Which feet bear load. The generalised momentum of each leg changes by gravity, motors and
/// ground; what the first two leave over is the ground's force. It is low-passed, with thresholds
/// after the expectation and hysteresis; a single tick's momentum jump beyond `spike_force` counts
/// at once, so that a touchdown is seen before the low-pass has risen. Real-time: nothing
/// allocates, locks or throws.
class ContactDetector {
 public:
  ContactDetector(const ContactConfig& config, const model::RobotParameters& robot);

  /// @param state    Of this tick, as known before contacts are used.
  /// @param readings Of the same tick: torques of the step that led to it.
  /// @param dt       Length of that step [s].
  const std::array<bool, core::kLegs>& update(const core::RobotState& state,
                                              const core::SensorReadings& readings,
                                              ContactExpectation expected, double dt) noexcept;

  /// Vertical force of the ground on a foot, low-passed [N].
  [[nodiscard]] double force(core::Leg leg) const { return feet_[core::index(leg)].force; }
  /// The same from the last tick alone [N].
  [[nodiscard]] double spike(core::Leg leg) const { return feet_[core::index(leg)].spike; }

 private:
  struct Foot {
    core::LegVector momentum = core::LegVector::Zero();  // at the last tick [N·m·s]
    core::LegVector drift = core::LegVector::Zero();     // at the last tick [N·m]
    core::LegVector residual = core::LegVector::Zero();  // [N·m]
    double force = 0.0;
    double spike = 0.0;
    double unloaded = 0.0;  // for so long [s]
    bool known = false;     // momentum holds a value
  };
  void observe(core::Leg leg, const core::RobotState& state, const core::SensorReadings& readings,
               double dt) noexcept;
  [[nodiscard]] double threshold(ContactExpectation expected) const noexcept;

  ContactConfig config_;
  model::RobotParameters robot_;
  std::array<Foot, core::kLegs> feet_;
  std::array<bool, core::kLegs> contact_{true, true};
};

}  // namespace hopscotch::control
