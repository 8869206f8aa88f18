#pragma once

#include <cmath>
#include <random>

#include "core/joint_command.hpp"
#include "core/jump_plan.hpp"
#include "core/landing_target.hpp"
#include "core/one_step_terrain.hpp"
#include "core/robot_state.hpp"
#include "core/sensor_readings.hpp"
#include "msgs/messages.hpp"

/// Values in which every number differs from every other, so that a swapped or forgotten member
/// shows.
namespace hopscotch::msgs::samples {

class Source {
 public:
  explicit Source(unsigned seed) : engine_(seed) {}
  /// A 32-bit number: those survive every channel to the bit.
  double number() { return std::uniform_real_distribution<float>(-10.0F, 10.0F)(engine_); }
  template <typename Vector>
  void fill(Vector& v) {
    for (Eigen::Index i = 0; i < v.size(); ++i) v.data()[i] = number();
  }
  void fill(core::ContactWrenches& wrenches) {
    for (core::Wrench& wrench : wrenches) {
      fill(wrench.force);
      fill(wrench.moment);
    }
  }

 private:
  std::mt19937 engine_;
};

inline core::SensorReadings sensors() {
  Source source(1);
  core::SensorReadings value;
  value.stamp = {123456789};
  source.fill(value.q);
  source.fill(value.dq);
  source.fill(value.tau);
  source.fill(value.w_WB_B);
  source.fill(value.f_B);
  return value;
}

inline core::RobotState state() {
  Source source(2);
  core::RobotState value;
  value.stamp = {-5};  // stamps before the start of the clock are legal
  source.fill(value.p_WB);
  source.fill(value.R_WB);
  source.fill(value.v_WB);
  source.fill(value.w_WB);
  source.fill(value.q);
  source.fill(value.dq);
  value.contact = {false, true};
  return value;
}

inline core::JointCommand command() {
  Source source(3);
  core::JointCommand value;
  value.stamp = {42};
  value.mode = core::DriveMode::active;
  source.fill(value.q);
  source.fill(value.dq);
  source.fill(value.kp);
  source.fill(value.kd);
  source.fill(value.tau);
  return value;
}

inline core::TerrainProfile profile(Source& source) {
  core::TerrainProfile value;
  for (std::size_t i = 0; i < value.state.size(); ++i) {
    value.lower[i] = source.number();
    value.mean[i] = source.number();
    value.upper[i] = source.number();
    value.state[i] = static_cast<core::CellState>(i % 3);
  }
  return value;
}

inline core::OneStepTerrain terrain() {
  Source source(4);
  core::OneStepTerrain value;
  value.stamp = {77};
  source.fill(value.p_WS);
  value.heading = source.number();
  value.coverage = 0.75;
  value.profile = profile(source);
  value.edge_count = 2;
  value.edges[0] = {source.number(), source.number(), source.number(), core::EdgeKind::down};
  value.edges[1] = {source.number(), source.number(), source.number(), core::EdgeKind::gap_far};
  value.gap_count = 1;
  value.gaps[0] = {source.number(), source.number(), source.number()};
  return value;
}

inline core::LandingTarget landing_target(Source& source) {
  core::LandingTarget value;
  for (Eigen::Isometry3d& X_WF : value.X_WF) {
    X_WF.linear() = Eigen::AngleAxisd(source.number(), Eigen::Vector3d::UnitZ()).toRotationMatrix();
    X_WF.translation() << source.number(), source.number(), source.number();
  }
  source.fill(value.p_WS);
  value.heading = source.number();
  value.distance = source.number();
  value.height = source.number();
  value.margin = source.number();
  value.safe_probability = source.number();
  value.source = core::TargetSource::truth;
  value.profile = profile(source);
  return value;
}

inline core::TargetChoice choice() {
  Source source(5);
  core::TargetChoice value;
  value.stamp = {88};
  value.target = landing_target(source);
  value.ranked_count = 2;
  for (std::size_t i = 0; i < value.ranked_count; ++i) {
    value.ranked[i] = {source.number(), source.number(), source.number(), source.number(),
                       source.number()};
  }
  value.rejected_count = 1;
  value.rejected[0] = {source.number(), core::Reason::gap_too_wide};
  return value;
}

inline core::JumpPlan plan() {
  Source source(6);
  core::JumpPlan value;
  value.id = 9;
  value.stamp = {99};
  value.target = landing_target(source);
  value.knot_count = core::JumpPlan::kMaxKnots;
  for (core::JumpKnot& knot : value.knots) {
    knot.time = source.number();
    knot.dt = source.number();
    knot.phase = core::JumpPhase::landing;
    knot.contact = {true, false};
    source.fill(knot.p_WB);
    source.fill(knot.rpy);
    source.fill(knot.v_WB);
    source.fill(knot.w_WB);
    source.fill(knot.p_WG);
    source.fill(knot.v_WG);
    source.fill(knot.q);
    source.fill(knot.dq);
    source.fill(knot.tau);
    source.fill(knot.wrenches);
  }
  value.liftoff_time = source.number();
  value.touchdown_time = source.number();
  value.duration = source.number();
  value.status = core::PlanStatus::iteration_limit;
  value.iterations = 31;
  value.warm = true;
  value.peaks = {source.number(), source.number(), source.number(), source.number()};
  value.certificate.max_violation = source.number();
  value.certificate.dense_max_violation = source.number();
  return value;
}

inline Status status() {
  Source source(7);
  Status value;
  value.control.stamp = {111};
  value.control.phase = core::RobotPhase::flight;
  value.control.fault = core::Reason::tilt_limit;
  value.control.plan_id = 4;
  value.control.plan_time = source.number();
  source.fill(value.control.wrenches);
  value.jump = 3;
  value.deadline_misses = 5;
  value.times = {source.number(), source.number(), core::kNaN, source.number(), source.number()};
  return value;
}

inline Truth truth() {
  Source source(8);
  Truth value;
  value.stamp = {222};
  value.state = state();
  source.fill(value.ground);
  source.fill(value.tau);
  return value;
}

inline Scene scene() {
  Source source(9);
  Scene value;
  value.stamp = {0};
  value.robot = "hector";
  value.goal_x = source.number();
  value.pit_z = source.number();
  value.slab_count = Scene::kMaxSlabs;
  for (SceneSlab& slab : value.slabs) {
    for (Eigen::Vector3d& corner : slab.top) source.fill(corner);
    slab.seen_rise = source.number();
  }
  return value;
}

}  // namespace hopscotch::msgs::samples
