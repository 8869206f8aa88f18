#include "apps/robot_brain.hpp"

#include "core/config_reader.hpp"
#include "model/stand_posture.hpp"
#include "sim/terrain_builder.hpp"

namespace hopscotch::apps {

namespace {

ProgramConfig tuning_for(const RobotConfig& config) {
  ProgramConfig tuning = config.tuning;
  tuning.footstep.preference.nominal_distance = config.session.jump_distance;
  return tuning;
}

/// Level ground all around, at the height of the soles at start-up.
Pipeline::TerrainOracle level_floor() {
  sim::Slab slab;
  constexpr double kHalfSize = 50.0;  // [m]
  slab.half_size.setConstant(kHalfSize);
  sim::Terrain floor;
  floor.slabs.push_back(slab);
  return [floor](const core::RobotState& state) -> MapDrawing {
    return [floor, centre = Eigen::Vector2d(state.p_WB.head<2>()), stamp = state.stamp] {
      return sim::seen_terrain_map(floor, centre, stamp);
    };
  };
}

}  // namespace

RobotBrain::RobotBrain(const RobotConfig& config, core::DepthSource* eyes)
    : camera_(eyes != nullptr ? *eyes : nothing_),
      pipeline_(
          tuning_for(config), config.robot, {},
          eyes != nullptr ? Pipeline::TerrainOracle{} : level_floor(),
          config.pacing.mode == Pacing::Mode::real_time ? Threading::threads : Threading::lockstep),
      jumps_per_command_(config.session.jumps_per_command) {}

SessionBrain RobotBrain::session_brain() {
  return {.tick = [this](const core::SensorReadings& readings) { return tick(readings); },
          .status = [this] { return pipeline_.status(); }};
}

core::JointCommand RobotBrain::tick(const core::SensorReadings& readings) {
  core::JointCommand command = pipeline_.tick(readings, camera_);
  if (!ticked_) hold();
  ticked_ = true;
  if (pipeline_.end() == MissionEnd::refused) {
    refusal_ = pipeline_.end_reason();
    pipeline_.reopen();
    hold();
  }
  const core::RobotPhase phase = pipeline_.status().phase;
  if (phase == core::RobotPhase::landing && phase_ == core::RobotPhase::flight) {
    ++jumps_;
    if (jumps_left_ > 0 && --jumps_left_ == 0) hold();
  }
  phase_ = phase;
  return command;
}

/// By the program's own wish: nobody gets an answer.
void RobotBrain::hold() {
  core::OperatorCommand command;
  command.mode = core::ModeRequest::hold;
  pipeline_.apply(command);
}

void RobotBrain::apply(const core::OperatorCommand& command) {
  if (command.mode == core::ModeRequest::jump) jumps_left_ = jumps_per_command_;
  pipeline_.apply(command);
}

core::JointVector landing_posture(const RobotConfig& config) {
  const auto pose = model::stand_pose(config.robot, config.tuning.stand_posture);
  if (!pose) throw core::ConfigError("stand_posture: " + config.robot.name + " cannot stand so");
  return pose->q;
}

}  // namespace hopscotch::apps
