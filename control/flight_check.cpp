#include "control/flight_check.hpp"

#include <cmath>

namespace hopscotch::control {

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
  standing_ = now.standing == 2 ? standing_ + dt : 0.0;
  if (standing_ <= config_.settle_time) {
    below_ = now.below;
    risen_ = watched_ = 0.0;
    return std::nullopt;
  }
  risen_ += now.rise_speed * dt;
  watched_ += dt;
  if (watched_ < config_.watch_time) return std::nullopt;
  const FlightError error{
      .rise_speed = (risen_ + now.below - below_) / watched_, .flown = flown_, .stood = landed_};
  *this = FlightCheck(config_);
  if (!(std::abs(error.rise_speed) > config_.speed_max)) return std::nullopt;
  return error;
}

}  // namespace hopscotch::control
