#pragma once

#include "control/recovery_hop.hpp"

namespace hopscotch::control::testing {

inline constexpr RecoveryHopConfig kHopConfig{.excess_along = 0.01,
                                              .excess_across = 0.01,
                                              .wait = 0.06,
                                              .lift_speed = 0.75,
                                              .push_acceleration = 9.0,
                                              .clearance = 0.03,
                                              .landing_height = 0.37,
                                              .reach_share = 1.0,
                                              .reach_max = 0.14};

}  // namespace hopscotch::control::testing
