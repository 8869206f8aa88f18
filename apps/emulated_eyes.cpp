#include "apps/emulated_eyes.hpp"

#include "apps/command_gate.hpp"

namespace hopscotch::apps {

EmulatedEyes::EmulatedEyes(const sim::Scenario& scenario, const model::RobotParameters& robot,
                           std::uint64_t seed, const std::string& url, Pacing::Mode pacing)
    : camera_(scenario.camera, robot, scenario.seen, seed),
      link_(url),
      events_(wall_clock_us()),
      drawing_({.name = "camera",
                .latency = 0.0,
                .threaded = pacing == Pacing::Mode::real_time,
                .thread = {}},
               [this](const Shot& shot, bool& sent) {
                 draw_and_send(shot);
                 sent = true;
               }) {}

void EmulatedEyes::look(const core::RobotState& truth, core::Stamp robot_time) {
  camera_.expose(truth);
  static_cast<void>(drawing_.made());
  static_cast<void>(drawing_.take(truth.stamp));
  if (!drawing_.vacant()) return;
  if (const std::optional<sim::SimCamera::Exposure> exposure = camera_.due(truth.stamp)) {
    const double ago = truth.stamp.since(exposure->truth.stamp);
    drawing_.question() = {*exposure, robot_time.after(-ago)};
    drawing_.ask(truth.stamp);
  }
}

/// A frame that the network refuses is lost, as a camera's would be.
void EmulatedEyes::draw_and_send(const Shot& shot) {
  msgs::DepthRecord record{.frame = camera_.draw(shot.exposure), .at_exposure = {}};
  record.frame.stamp = shot.stamp;
  const msgs::Event event = events_.make(shot.stamp, record);
  static_cast<void>(link_.publish(event.channel, event.bytes));
}

}  // namespace hopscotch::apps
