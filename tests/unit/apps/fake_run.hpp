#pragma once

#include <cmath>
#include <filesystem>
#include <string>

#include "apps/run_folder.hpp"
#include "apps/run_result.hpp"
#include "model/robot_parameters.hpp"
#include "msgs/run_log.hpp"

/// A run folder as if the robot had crossed a gap with two jumps: the trunk flies parabolas, the
/// legs hold still. Nothing here is physics; it only has the shape of a run.
namespace hopscotch::apps::fake {

inline constexpr double kDistance = 0.40;  // of a jump [m]
inline constexpr double kStand = 0.5;      // before and after each jump [s]
inline constexpr double kTakeoff = 0.4;    // [s]
inline constexpr double kFlight = 0.3;     // [s]
inline constexpr double kLanding = 0.4;    // [s]
inline constexpr double kJump = kTakeoff + kFlight + kLanding;
inline constexpr double kTrunkHeight = 0.5481;  // above the soles, with the posture below [m]
inline constexpr double kWeight = 137.8;        // [N]

inline core::JointVector posture() {
  core::JointVector q;
  q << 0.0, 0.0, 0.785, -1.571, 0.786, 0.0, 0.0, 0.785, -1.571, 0.786;
  return q;
}

/// Place along x and height above the stand of a jump, by the time since its start.
inline Eigen::Vector2d along_jump(double time) {
  if (time < kTakeoff) return {0.0, -0.12 * std::sin(M_PI * time / kTakeoff)};
  if (time < kTakeoff + kFlight) {
    const double share = (time - kTakeoff) / kFlight;
    return {kDistance * share, 0.5 * share * (1.0 - share)};
  }
  return {kDistance, -0.08 * std::sin(M_PI * (time - kTakeoff - kFlight) / kLanding)};
}

inline core::RobotPhase phase_at(double jump_time) {
  if (jump_time < 0.0 || jump_time >= kJump) return core::RobotPhase::stand;
  if (jump_time < kTakeoff) return core::RobotPhase::takeoff;
  return jump_time < kTakeoff + kFlight ? core::RobotPhase::flight : core::RobotPhase::landing;
}

inline double normal_force(double jump_time) {
  switch (phase_at(jump_time)) {
    case core::RobotPhase::flight: return 0.0;
    case core::RobotPhase::takeoff: return kWeight * (1.0 + jump_time / kTakeoff);
    default: return kWeight;
  }
}

inline msgs::Truth truth_at(double time, double start_x, double jump_time) {
  msgs::Truth truth;
  truth.stamp = core::Stamp::from_seconds(time);
  core::RobotState& state = truth.state;
  state.stamp = truth.stamp;
  const bool jumping = phase_at(jump_time) != core::RobotPhase::stand;
  const Eigen::Vector2d shift = jumping ? along_jump(jump_time) : Eigen::Vector2d::Zero();
  state.p_WB << start_x + shift.x(), 0.0, kTrunkHeight + shift.y();
  const double pitch = jumping ? 0.2 * std::sin(2.0 * M_PI * jump_time / kJump) : 0.0;
  state.R_WB = Eigen::AngleAxisd(pitch, Eigen::Vector3d::UnitY()).toRotationMatrix();
  state.v_WB.setZero();
  state.w_WB.setZero();
  state.q = posture();
  state.dq = core::JointVector::Constant(jumping ? 8.0 * std::sin(7.0 * jump_time) : 0.0);
  truth.tau = core::JointVector::Constant(jumping ? 25.0 * std::cos(5.0 * jump_time) : 10.0);
  for (core::Wrench& foot : truth.ground) foot.force.z() = 0.5 * normal_force(jump_time);
  return truth;
}

inline core::JumpPlan plan_at(double time, double start_x, std::uint64_t id) {
  core::JumpPlan plan;
  plan.id = id;
  plan.stamp = core::Stamp::from_seconds(time);
  plan.status = core::PlanStatus::solved;
  plan.liftoff_time = kTakeoff;
  plan.touchdown_time = kTakeoff + kFlight;
  plan.duration = kJump;
  plan.knot_count = 111;
  for (std::size_t i = 0; i < plan.knot_count; ++i) {
    core::JumpKnot& knot = plan.knots[i];
    knot.time = static_cast<double>(i) * 0.01;
    knot.dt = 0.01;
    const Eigen::Vector2d shift = along_jump(knot.time);
    knot.p_WG << start_x + shift.x() + 0.01, 0.0, 0.47 + shift.y();
    knot.rpy.setZero();
    for (core::Wrench& foot : knot.wrenches) foot.force.z() = 0.5 * normal_force(knot.time);
  }
  core::LandingTarget& target = plan.target;
  target.p_WS << start_x, 0.0, 0.0;
  target.heading = 0.0;
  target.distance = kDistance;
  target.height = 0.0;
  target.margin = 0.06;
  target.safe_probability = 0.99;
  for (Eigen::Isometry3d& X_WF : target.X_WF) X_WF.translation() << start_x + kDistance, 0.1, 0.0;
  target.profile.state.fill(core::CellState::observed);
  target.profile.state[70] = core::CellState::never_seen;
  return plan;
}

inline core::TargetChoice choice_of(const core::JumpPlan& plan) {
  core::TargetChoice choice;
  choice.stamp = plan.stamp;
  choice.target = plan.target;
  choice.ranked_count = 2;
  choice.ranked[0] = {kDistance, 0.0, 0.06, 0.4, 0.99};
  choice.ranked[1] = {0.38, 0.0, 0.05, 0.4, 0.98};
  choice.rejected_count = 2;
  choice.rejected[0] = {0.25, core::Reason::tread_too_short};
  choice.rejected[1] = {0.9, core::Reason::out_of_reach};
  return choice;
}

inline msgs::Scene scene() {
  msgs::Scene scene;
  scene.robot = "hector";
  scene.goal_x = 2.0 * kDistance;
  scene.pit_z = -0.5;
  scene.slab_count = 2;
  const auto slab = [](double begin, double end) {
    msgs::SceneSlab result;
    result.top = {Eigen::Vector3d(begin, -0.6, 0.0), Eigen::Vector3d(end, -0.6, 0.0),
                  Eigen::Vector3d(end, 0.6, 0.0), Eigen::Vector3d(begin, 0.6, 0.0)};
    return result;
  };
  scene.slabs[0] = slab(-1.0, 0.12);
  scene.slabs[1] = slab(0.28, 2.0);
  scene.slabs[1].seen_rise = 0.02;
  return scene;
}

inline RunResult result() {
  RunResult result;
  result.run_id = "0123456789abcdef";
  result.scenario = "gap & <step>";  // names are text, not markup
  result.seed = 7;
  result.program = "0.1.0";
  result.perception = "camera";
  result.state = "truth";
  result.outcome = RunOutcome::completed;
  result.duration = 2.0 * (kJump + kStand) + kStand;
  for (int index = 1; index <= 2; ++index) {
    JumpResult jump;
    jump.index = index;
    jump.outcome = JumpOutcome::landed;
    jump.start = kStand + (kStand + kJump) * (index - 1);
    jump.target = {kDistance, 0.0, core::TargetSource::perception};
    jump.landing = {0.395, 0.001, 0.06, 0.05, 0.08};
    jump.plan = {core::PlanStatus::solved, 18, index > 1, 27, kJump, "knee power", 0.12};
    jump.takeoff = {1.1, 1.6, core::kNaN};
    jump.flight = kFlight;
    jump.peak = {0.81, 0.9, 0.95, 610.0};
    result.jumps.push_back(jump);
  }
  result.timing.plan_ms = {210.0, 260.0, 260.0};
  result.timing.mpc_ms = {0.1, 0.2, 0.3};
  result.timing.real_time_factor = 1.7;
  return result;
}

inline void write_log(const std::filesystem::path& file) {
  msgs::RunLogWriter log(file, 1);
  log.write({}, scene());
  const double period = kJump + kStand;
  const int ticks = static_cast<int>(1000.0 * (2.0 * period + kStand));
  for (int tick = 0; tick < ticks; ++tick) {
    const double time = 1e-3 * tick;
    const core::Stamp now = core::Stamp::from_seconds(time);
    const int round = std::min(static_cast<int>(time / period), 1);
    const double jump_time = time - round * period - kStand;
    const double start_x = kDistance * (jump_time >= kJump ? round + 1 : round);
    log.write(now, truth_at(time, start_x, jump_time));
    const bool decides = std::abs(jump_time + 0.1) < 0.5e-3;  // 0.1 s before each jump
    if (decides) {
      const core::JumpPlan plan = plan_at(time, start_x, static_cast<std::uint64_t>(round + 1));
      log.write(now, choice_of(plan));
      log.write(now, plan);
    }
    msgs::Status status;
    status.control.stamp = now;
    status.control.phase = phase_at(jump_time);
    status.control.plan_id = static_cast<std::uint64_t>(jump_time >= 0.0 ? round + 1 : round);
    status.control.plan_time = jump_time;
    status.times.tick_ms = 0.01 + 0.001 * (tick % 7);
    if (tick % 5 == 0) status.times.mpc_ms = 0.1 + 0.01 * (tick % 13);
    if (tick % 33 == 0) status.times.perception_ms = 3.0 + 0.1 * (tick % 9);
    if (decides) status.times.plan_ms = 210.0;
    log.write(now, status);
  }
  log.close();
}

/// Everything that a report needs, except pictures.
inline void write_run(const RunFolder& folder) {
  std::filesystem::create_directories(folder.path);
  write_run_result(folder.result(), result());
  std::filesystem::copy_file(
      std::filesystem::path(HOPSCOTCH_SOURCE_DIR) / "config/robots/hector.yaml", folder.robot(),
      std::filesystem::copy_options::overwrite_existing);
  write_log(folder.log());
}

}  // namespace hopscotch::apps::fake
