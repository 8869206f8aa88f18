#include "apps/following_camera.hpp"

#include <cmath>

namespace hopscotch::apps {

sim::View FollowingCamera::view(const core::RobotState& state, double dt) {
  constexpr double kAlong = 0.25;             // time constant along the course [s]
  constexpr double kUpward = 0.8;             // and of the height [s]
  constexpr double kTrunkAboveMiddle = 0.16;  // so that legs and ground are seen [m]
  const auto share = [&](double constant) {
    return started_ ? 1.0 - std::exp(-dt / constant) : 1.0;
  };
  const double height = state.p_WB.z() - kTrunkAboveMiddle;
  middle_.head<2>() += share(kAlong) * (state.p_WB.head<2>() - middle_.head<2>());
  middle_.z() += share(kUpward) * (height - middle_.z());
  started_ = true;
  return {.target = middle_,
          .distance = 2.0,
          .azimuth = kSideways + 0.35,
          .elevation = -0.16,
          .field_of_view = 0.7};
}

}  // namespace hopscotch::apps
