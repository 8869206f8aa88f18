#pragma once

#include <array>
#include <optional>

#include "control/estimator_config.hpp"
#include "core/robot_layout.hpp"

namespace hopscotch::control {

/// What the soles say of one tick.
struct SolesNow {
  int standing = 0;  ///< Of two.
  /// Height over the trunk of what each stands on, by the legs [m].
  std::array<double, core::kLegs> below{};
  double rise_speed = 0.0;  ///< Of the trunk, as it is believed [m/s].
};

/// What a flight did to the estimate.
struct FlightError {
  double rise_speed = 0.0;  ///< Believed less true [m/s].
  double flown = 0.0;       ///< So long nothing corrected the inertial sensor [s].
  double stood = 0.0;       ///< Since the touchdown [s].
};

/// Holds the vertical speed that the inertial sensor led to against soles that stand after a
/// flight, twice in a row: an error is what both soles tell both times, the least of the four.
/// Real-time: nothing allocates, locks or throws.
class FlightCheck {
 public:
  explicit FlightCheck(const FlightCheckConfig& config) : config_(config) {}

  /// One tick; `dt` since the last one [s].
  /// @return once after a landing, when the speed does not fit.
  std::optional<FlightError> update(const SolesNow& now, double dt) noexcept;

 private:
  [[nodiscard]] double watched_error(const SolesNow& now) const noexcept;
  void watch(const SolesNow& now) noexcept;

  FlightCheckConfig config_;
  double flown_ = 0.0;                       ///< Without an answer yet; 0: nothing to check [s].
  double landed_ = 0.0;                      ///< Since the touchdown [s].
  double standing_ = 0.0;                    ///< Both soles, without a break [s].
  std::array<double, core::kLegs> below_{};  ///< When this watch began [m].
  double risen_ = 0.0;                       ///< Believed, since then [m].
  double watched_ = 0.0;                     ///< Since then [s].
  std::optional<double> first_;              ///< Error that the first watch found [m/s].
};

}  // namespace hopscotch::control
