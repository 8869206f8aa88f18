#pragma once

#include <optional>

#include "control/estimator_config.hpp"

namespace hopscotch::control {

/// What the soles say of one tick.
struct SolesNow {
  int standing = 0;         ///< Of two.
  double below = 0.0;       ///< Height of what they stand on over the trunk, by the legs [m].
  double rise_speed = 0.0;  ///< Of the trunk, as it is believed [m/s].
};

/// What a flight did to the estimate.
struct FlightError {
  double rise_speed = 0.0;  ///< Believed less true [m/s].
  double flown = 0.0;       ///< So long nothing corrected the inertial sensor [s].
  double stood = 0.0;       ///< Since the touchdown [s].
};

/// Holds the vertical speed that the inertial sensor led to against soles that stand after a
/// flight. Real-time: nothing allocates, locks or throws.
class FlightCheck {
 public:
  explicit FlightCheck(const FlightCheckConfig& config) : config_(config) {}

  /// One tick; `dt` since the last one [s].
  /// @return once after a landing, when the speed does not fit.
  std::optional<FlightError> update(const SolesNow& now, double dt) noexcept;

 private:
  FlightCheckConfig config_;
  double flown_ = 0.0;     ///< Without an answer yet; 0: nothing to check [s].
  double landed_ = 0.0;    ///< Since the touchdown [s].
  double standing_ = 0.0;  ///< Both soles, without a break [s].
  double below_ = 0.0;     ///< When the soles had come to rest [m].
  double risen_ = 0.0;     ///< Believed, since then [m].
  double watched_ = 0.0;   ///< Since then [s].
};

}  // namespace hopscotch::control
