#pragma once

#include <optional>
#include <string>

#include "apps/robot_config.hpp"
#include "apps/stage.hpp"
#include "core/depth_frame.hpp"
#include "msgs/event.hpp"
#include "msgs/live_link.hpp"
#include "sim/scenario.hpp"
#include "sim/sim_camera.hpp"

namespace hopscotch::apps {

/// The depth camera of the emulated robot: draws what it sees and sends it as HOP_DEPTH, as the
/// bridge of a real camera does.
class EmulatedEyes {
 public:
  /// @param pacing By the clock, drawing and sending happen on a thread of their own.
  /// @throws msgs::LiveUnavailable when the machine cannot carry live messages.
  EmulatedEyes(const sim::Scenario& scenario, const model::RobotParameters& robot,
               std::uint64_t seed, const std::string& url, Pacing::Mode pacing);

  /// At every tick of the world.
  /// @param truth      Of this tick.
  /// @param robot_time The same moment by the robot's clock, which frames are stamped with.
  void look(const core::RobotState& truth, core::Stamp robot_time);

 private:
  struct Shot {
    sim::SimCamera::Exposure exposure;
    core::Stamp stamp;
  };
  void draw_and_send(const Shot& shot);

  sim::SimCamera camera_;
  msgs::LiveLink link_;
  msgs::EventMaker events_;
  Stage<Shot, bool> drawing_;
};

}  // namespace hopscotch::apps
