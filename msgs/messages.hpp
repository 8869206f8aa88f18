#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include "core/contact_wrenches.hpp"
#include "core/control_status.hpp"
#include "core/depth_frame.hpp"
#include "core/landing_target.hpp"
#include "core/operator_command.hpp"
#include "core/reason.hpp"
#include "core/robot_layout.hpp"
#include "core/robot_state.hpp"
#include "core/terrain_map.hpp"
#include "core/time.hpp"

/// What travels on the channels besides the values of `core`.
namespace hopscotch::msgs {

/// What every message carries besides its stamp.
struct Tag {
  std::uint64_t sequence = 0;  ///< Per channel and sender, from 1.
  std::uint64_t run_id = 0;    ///< Of the sender.
};

/// HOP_DEPTH: a depth frame and the state it was laid over the world with. Depth travels as 16-bit
/// whole millimetres where all readings are such, else in tenths; what is not finite, not positive
/// or too far comes back as 0.
struct DepthRecord {
  core::DepthFrame frame;
  core::RobotState at_exposure;  ///< Interpolated to the frame's stamp.
};

/// HOP_ANCHOR: the state at which the map was tied to the ground under the soles.
struct AnchorRecord {
  core::RobotState state;
};

/// HOP_QUESTION: what footstep was asked.
struct TargetQuestion {
  core::Stamp stamp;
  core::Stamp map_stamp;       ///< Of the newest frame in the map it was asked about.
  core::RobotState rest;       ///< The stance to jump from.
  double goal_x = core::kNaN;  ///< [m]; NaN: none.
  double goal_heading = 0.0;   ///< In W [rad].
  core::TargetSource source = core::TargetSource::perception;
  std::optional<core::TargetOverride> target;  ///< A place asked for.
  double height_doubt = 0.0;                   ///< Of the map ahead [m].
  bool for_operator = false;                   ///< By the operator, not as the next best one.
};

/// HOP_PRIOR: what the estimator took in besides the readings, from the next ones on. Recorded when
/// it changes.
struct EstimatorPrior {
  /// Where the robot was put down, which starts the filter.
  struct Start {
    Eigen::Vector3d p_WS = Eigen::Vector3d::Zero();  ///< Mid-point of the soles [m].
    double yaw = 0.0;                                ///< Of the trunk [rad].
  };
  core::Stamp stamp;
  std::optional<Start> start;
  std::uint8_t expected = 0;   ///< Number of a control::ContactExpectation.
  double height = core::kNaN;  ///< Of the standing soles by the map, used once [m]; NaN: none.
};

/// HOP_TARGET_CMD: the operator's landing target; no target clears an earlier one.
struct TargetCommand {
  core::Stamp stamp;
  std::optional<core::TargetOverride> target;
};

/// HOP_COMMAND_CMD: the operator's wish for a mode.
struct ModeCommand {
  core::Stamp stamp;
  core::ModeRequest mode = core::ModeRequest::none;
  double goal_x = core::kNaN;  ///< New goal along the initial heading [m]; NaN: no change.
};

/// HOP_ACK: the answer to either.
struct Ack {
  core::Stamp stamp;                   ///< Of the tick that answered.
  std::string channel;                 ///< That the command came on.
  std::uint64_t command_sequence = 0;  ///< Of the command.
  bool accepted = false;
  core::Refusal refusal;         ///< Why not; when accepted its sentence says what follows.
  double start_in = core::kNaN;  ///< Until the jump starts, or may be asked for again [s].
};

/// Computing time of the stages whose work ended since the last status [ms]; NaN: none ended.
struct StageTimes {
  double tick_ms = core::kNaN;
  double mpc_ms = core::kNaN;
  double plan_ms = core::kNaN;
  double perception_ms = core::kNaN;
  double estimator_ms = core::kNaN;
};

/// HOP_STATUS: what the program is doing.
struct Status {
  core::ControlStatus control;  ///< Its stamp is that of the message.
  int jump = 0;                 ///< From 1; 0 before the first.
  int deadline_misses = 0;      ///< So far.
  bool held = false;            ///< By the operator: it lands and stands.
  StageTimes times;
};

/// HOP_TRUTH, simulation only: what the plant really does. For reports and judging, never for
/// control.
struct Truth {
  core::Stamp stamp;
  core::RobotState state;
  core::ContactWrenches ground{};  ///< Of the ground on each foot, at the sole centre, in W.
  core::JointVector tau = core::JointVector::Constant(core::kNaN);  ///< Applied, joint side [N·m].
};

/// HOP_MAP: the part of the height map around a decision, for people: heights are rounded to a
/// millimetre.
struct MapView {
  static constexpr int kMaxSide = 96;  ///< [cells]
  static constexpr std::size_t kMaxCells = kMaxSide * kMaxSide;
  core::Stamp stamp;                                ///< Of the newest frame in it.
  double origin_x = 0.0;                            ///< Lower corner, in W [m].
  double origin_y = 0.0;                            ///< [m]
  double resolution = 0.0;                          ///< Edge of a cell [m].
  int size_x = 0;                                   ///< [cells]
  int size_y = 0;                                   ///< [cells]
  std::array<std::int16_t, kMaxCells> height_mm{};  ///< [iy * size_x + ix]; 0 where not observed.
  std::array<core::CellState, kMaxCells> state{};
};

/// One thing to stand on, as drawn.
struct SceneSlab {
  /// Corners of the true top, counter-clockwise from near right, in W [m].
  std::array<Eigen::Vector3d, 4> top{};
  double seen_rise = 0.0;  ///< Top that perception is shown, above the true one [m].
};

/// HOP_SCENE, simulation only, once per log: the terrain of the scenario.
struct Scene {
  static constexpr std::size_t kMaxSlabs = 128;
  core::Stamp stamp;
  std::string robot;           ///< Name of the robot's file.
  double goal_x = core::kNaN;  ///< [m]; NaN: none.
  double pit_z = core::kNaN;   ///< Floor between the slabs [m].
  std::array<SceneSlab, kMaxSlabs> slabs{};
  std::size_t slab_count = 0;
};

}  // namespace hopscotch::msgs
