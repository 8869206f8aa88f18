#include "control/flight_check.hpp"

#include <algorithm>
#include <cmath>

namespace hopscotch::control {

namespace {

/// What two readings have in common: the smaller one, nothing if they point apart.
double common(double a, double b) {
  if (a > 0.0 && b > 0.0) return std::min(a, b);
  if (a < 0.0 && b < 0.0) return std::max(a, b);
  return 0.0;
}

}  // namespace

/// Believed less true speed, as both soles have it.
double FlightCheck::watched_error(const SolesNow& now) const noexcept {
  return common((risen_ + now.below[0] - below_[0]) / watched_,
                (risen_ + now.below[1] - below_[1]) / watched_);
}

void FlightCheck::watch(const SolesNow& now) noexcept {
  below_ = now.below;
  risen_ = watched_ = 0.0;
}

std::optional<FlightError> FlightCheck::update(const SolesNow& now, double dt) noexcept {
  if (now.standing == 0) {
    flown_ += landed_ + dt;  // a bounce belongs to the flight before it
    landed_ = standing_ = 0.0;
    return std::nullopt;
  }
  if (flown_ == 0.0) return std::nullopt;
  constexpr double kTooLate = 0.2;  // [s]: by then the speed is that of the legs anyway
  landed_ += dt;
  if (landed_ > kTooLate) *this = FlightCheck(config_);
  standing_ = now.standing == core::kLegs ? standing_ + dt : 0.0;
  if (standing_ <= config_.settle_time) {
    watch(now);
    first_.reset();
    return std::nullopt;
  }
  risen_ += now.rise_speed * dt;
  watched_ += dt;
  if (watched_ < config_.watch_time) return std::nullopt;
  const double error = watched_error(now);
  if (!first_) {
    first_ = error;
    watch(now);
    return std::nullopt;
  }
  const FlightError found{.rise_speed = common(*first_, error), .flown = flown_, .stood = landed_};
  *this = FlightCheck(config_);
  if (!(std::abs(found.rise_speed) > config_.speed_max)) return std::nullopt;
  return found;
}

}  // namespace hopscotch::control
