#pragma once

namespace hopscotch::model {

/// Standard gravity, along -z of W [m/s^2]. One value for plans, control and simulation.
inline constexpr double kGravity = 9.80665;

}  // namespace hopscotch::model
