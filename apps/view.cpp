#include "apps/view.hpp"

#include "sim/scene_builder.hpp"

namespace hopscotch::apps {

LiveView::LiveView(const RunRequest& request)
    : window_(sim::scene_mjcf(request.plant_robot, request.scenario.true_terrain()),
              "Hopscotch: " + request.scenario.name) {}

void LiveView::show(const core::RobotState& state) {
  constexpr double kPeriod = 1.0 / 30.0;  // of the pictures, simulated [s]
  const double since = shown_ ? state.stamp.since(*shown_) : kPeriod;
  if (since < kPeriod) return;
  window_.show(state, camera_.view(state, since));
  shown_ = state.stamp;
}

}  // namespace hopscotch::apps
