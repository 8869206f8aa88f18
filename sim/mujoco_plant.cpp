#include "sim/mujoco_plant.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "model/kinematics.hpp"
#include "sim/ankle_coupling.hpp"
#include "sim/disturbance.hpp"
#include "sim/drive.hpp"
#include "sim/mujoco_model.hpp"
#include "sim/random.hpp"
#include "sim/scene_builder.hpp"
#include "sim/sensor_model.hpp"
#include "sim/terrain_builder.hpp"

namespace hopscotch::sim {
namespace {

using core::JointVector;
using Eigen::Vector3d;
using RowMatrix3d = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;

constexpr std::uint64_t kStartStream = 0x57;  // the start variation's own random numbers

model::RobotParameters scaled_links(model::RobotParameters robot, const PlantSetup& plant) {
  const auto scale_link = [&plant](model::LinkParameters& link) {
    link.mass *= plant.mass_scale;
    link.inertia *= plant.mass_scale * plant.inertia_scale;
  };
  scale_link(robot.trunk);
  for (model::JointParameters& joint : robot.joints) scale_link(joint.link);
  return robot;
}

/// The ideal start with the seed's variation, its soles' mid-point still at the start place.
core::RobotState start_state(const PlantOptions& options, const Terrain& terrain) {
  Random random = Random::stream(options.seed, kStartStream);
  const StartPlace& place = options.scenario.start;
  core::RobotState state;
  state.stamp = {};
  state.q = options.posture.q + options.variation.joint * random.uniform_vector<core::kJoints>();
  state.dq.setZero();
  state.R_WB = model::rotation_from_rpy({0.0, options.posture.trunk_pitch, place.yaw});
  state.v_WB = options.variation.velocity * random.uniform_vector<3>();
  state.w_WB.setZero();
  state.p_WB.setZero();
  const auto soles = model::sole_poses(options.robot, state);
  const Vector3d middle = 0.5 * (soles[0].translation() + soles[1].translation());
  state.p_WB = Vector3d(place.x, 0.0, 0.0) - Vector3d(middle.x(), middle.y(), 0.0);
  double lift = -std::numeric_limits<double>::infinity();
  for (const Eigen::Isometry3d& X_WF : model::sole_poses(options.robot, state)) {
    const model::SoleTips tips = model::sole_tips(options.robot, X_WF);
    for (const Vector3d& tip : {tips.toe, tips.heel}) {
      const double ground = terrain.top_at(tip.head<2>()).value_or(-terrain.pit_depth);
      lift = std::max(lift, ground - tip.z());
    }
  }
  state.p_WB.z() += lift + place.drop;
  return state;
}

/// Where things are in MuJoCo's arrays.
struct Layout {
  std::array<int, core::kJoints> q_address{};
  std::array<int, core::kJoints> v_address{};
  std::array<int, core::kJoints> actuator{};
  std::array<int, core::kLegs> foot_body{};
  std::array<int, core::kLegs> sole_site{};
  int trunk_body = 0;
  int pit_floor = 0;

  explicit Layout(const mjModel& model) {
    for (const core::Leg leg : core::kAllLegs) {
      const std::string side = std::string(core::kLegNames[core::index(leg)]) + "_";
      for (std::size_t j = 0; j < core::kJointsPerLeg; ++j) {
        const std::string name = side + std::string(core::kJointNames[j]);
        const std::size_t i = static_cast<std::size_t>(core::leg_offset(leg)) + j;
        const int joint = element_id(model, mjOBJ_JOINT, name);
        q_address[i] = model.jnt_qposadr[joint];
        v_address[i] = model.jnt_dofadr[joint];
        actuator[i] = element_id(model, mjOBJ_ACTUATOR, name);
      }
      foot_body[core::index(leg)] = element_id(model, mjOBJ_BODY, side + "foot");
      sole_site[core::index(leg)] = element_id(model, mjOBJ_SITE, side + "sole");
    }
    trunk_body = element_id(model, mjOBJ_BODY, "trunk");
    pit_floor = element_id(model, mjOBJ_GEOM, std::string(kPitFloorName));
  }
};

/// Force of geom 1 on geom 2 of a contact, in W [N].
Vector3d contact_force(const mjModel& model, const mjData& data, int contact) {
  Eigen::Vector<double, 6> wrench;
  mj_contactForce(&model, &data, contact, wrench.data());
  const Eigen::Map<const RowMatrix3d> axes(data.contact[contact].frame);
  return axes.transpose() * wrench.head<3>();
}

std::string fault_sentence(const mjModel& model, const mjData& data) {
  for (int i = 0; i < mjNWARNING; ++i) {
    const mjWarningStat& warning = data.warning[i];
    if (warning.number > 0) return std::string("MuJoCo: ") + mju_warningText(i, warning.lastinfo);
  }
  const Eigen::Map<const Eigen::VectorXd> qpos(data.qpos, model.nq);
  const Eigen::Map<const Eigen::VectorXd> qvel(data.qvel, model.nv);
  return qpos.allFinite() && qvel.allFinite() ? "" : "MuJoCo: the state is not finite";
}

}  // namespace

struct MujocoPlant::World {
  explicit World(const PlantOptions& options);

  void place(const core::RobotState& start);
  void step(const core::JointCommand& command);
  [[nodiscard]] core::RobotState state() const;
  [[nodiscard]] core::SensorReadings perfect_readings(const Vector3d& acceleration_W) const;
  void add_contact(int index, PlantTruth& truth) const;

  model::RobotParameters robot;
  double motor_strength;
  int exchange_period;
  ModelPointer model;
  DataPointer data;
  Layout layout;
  AnkleCoupling coupling;
  CommandDelay delay;
  PushSchedule pushes;
  SensorModel sensors;
  std::int64_t tick = 0;
  JointVector tau = JointVector::Zero();           // applied in the last tick [N·m]
  JointVector speed_at_tau = JointVector::Zero();  // joint speeds it was limited for [rad/s]
  core::SensorReadings drive_reading;              // of this tick, at the drives
  core::SensorReadings delivered;                  // what the host has got last
  Vector3d force_sum = Vector3d::Zero();           // specific force since then, in B [m/s^2]
  std::string fault;
};

MujocoPlant::World::World(const PlantOptions& options)
    : robot(scaled_links(options.robot, options.scenario.plant)),
      motor_strength(options.scenario.plant.motor_strength),
      exchange_period(options.scenario.plant.exchange_period),
      model(compile_model(scene_mjcf(robot, options.scenario.true_terrain()))),
      data(make_data(*model)),
      layout(*model),
      coupling(*model, robot),
      delay(options.scenario.plant.latency_ticks),
      pushes(options.scenario.pushes),
      sensors(options.seed, options.scenario.plant.sensor_noise) {
  place(start_state(options, options.scenario.true_terrain()));
  drive_reading = sensors.measure(perfect_readings(Vector3d::Zero()));
  delivered = drive_reading;
}

void MujocoPlant::World::place(const core::RobotState& start) {
  const Eigen::Quaterniond attitude(start.R_WB);
  Eigen::Map<Vector3d>(data->qpos) = start.p_WB;
  Eigen::Map<Eigen::Vector4d>(data->qpos + 3) =
      Eigen::Vector4d(attitude.w(), attitude.x(), attitude.y(), attitude.z());
  Eigen::Map<Vector3d>(data->qvel) = start.v_WB;
  // A free joint's linear velocity is in world axes, its angular velocity in body axes.
  Eigen::Map<Vector3d>(data->qvel + 3) = start.R_WB.transpose() * start.w_WB;
  for (int i = 0; i < core::kJoints; ++i) {
    data->qpos[layout.q_address[static_cast<std::size_t>(i)]] = start.q[i];
    data->qvel[layout.v_address[static_cast<std::size_t>(i)]] = start.dq[i];
  }
  coupling.forward(*model, *data);
}

core::RobotState MujocoPlant::World::state() const {
  core::RobotState result;
  result.stamp = {tick * core::Stamp::from_seconds(kTick).nanoseconds};
  const double* quaternion = data->qpos + 3;
  result.p_WB = Eigen::Map<const Vector3d>(data->qpos);
  result.R_WB = Eigen::Quaterniond(quaternion[0], quaternion[1], quaternion[2], quaternion[3])
                    .normalized()
                    .toRotationMatrix();
  result.v_WB = Eigen::Map<const Vector3d>(data->qvel);
  result.w_WB = result.R_WB * Eigen::Map<const Vector3d>(data->qvel + 3);
  for (int i = 0; i < core::kJoints; ++i) {
    result.q[i] = data->qpos[layout.q_address[static_cast<std::size_t>(i)]];
    result.dq[i] = data->qvel[layout.v_address[static_cast<std::size_t>(i)]];
  }
  return result;
}

core::SensorReadings MujocoPlant::World::perfect_readings(const Vector3d& acceleration_W) const {
  const core::RobotState now = state();
  core::SensorReadings readings;
  readings.stamp = now.stamp;
  readings.q = now.q;
  readings.dq = now.dq;
  readings.tau = tau;
  readings.w_WB_B = now.R_WB.transpose() * now.w_WB;
  const Eigen::Map<const Vector3d> gravity(model->opt.gravity);
  readings.f_B = now.R_WB.transpose() * (acceleration_W - gravity);
  return readings;
}

void MujocoPlant::World::step(const core::JointCommand& command) {
  if (tick % exchange_period == 0) delay.send(tick, command);
  const core::RobotState before = state();
  const DriveReading reading{.q = drive_reading.q, .dq = drive_reading.dq};
  tau = limited_by_motors(robot, drive_demand(delay.in_force(tick), reading), before.dq,
                          motor_strength);
  speed_at_tau = before.dq;
  for (int i = 0; i < core::kJoints; ++i) {
    data->ctrl[layout.actuator[static_cast<std::size_t>(i)]] = tau[i];
  }
  Eigen::Map<Vector3d>(data->xfrc_applied + 6 * layout.trunk_body) = pushes.force(tick);
  coupling.step(*model, *data);
  ++tick;
  const Vector3d v_after = Eigen::Map<const Vector3d>(data->qvel);
  drive_reading = sensors.measure(perfect_readings((v_after - before.v_WB) / kTick));
  force_sum += drive_reading.f_B;
  if (tick % exchange_period == 0) {
    // The inertial sensor integrates between exchanges; nothing of a short impact is lost.
    delivered = drive_reading;
    delivered.f_B = force_sum / exchange_period;
    force_sum.setZero();
  }
  fault = fault_sentence(*model, *data);
}

void MujocoPlant::World::add_contact(int index, PlantTruth& truth) const {
  const mjContact& contact = data->contact[index];
  if (contact.exclude != 0) return;
  const bool first_is_ground = model->geom_bodyid[contact.geom1] == 0;
  const int ground_geom = first_is_ground ? contact.geom1 : contact.geom2;
  const int robot_body = model->geom_bodyid[first_is_ground ? contact.geom2 : contact.geom1];
  const Vector3d force = (first_is_ground ? 1.0 : -1.0) * contact_force(*model, *data, index);
  const Vector3d p_W = Eigen::Map<const Vector3d>(contact.pos);
  for (std::size_t leg = 0; leg < core::kLegs; ++leg) {
    if (robot_body != layout.foot_body[leg]) continue;
    // Sole and contact both as they were at the start of the tick.
    const Vector3d p_WF = Eigen::Map<const Vector3d>(data->site_xpos + 3 * layout.sole_site[leg]);
    truth.ground[leg].force += force;
    truth.ground[leg].moment += (p_W - p_WF).cross(force);
    truth.foot_in_pit = truth.foot_in_pit || ground_geom == layout.pit_floor;
    return;
  }
  truth.body_contacts.push_back(
      {.part = mj_id2name(model.get(), mjOBJ_BODY, robot_body),
       .ground = mj_id2name(model.get(), mjOBJ_GEOM, ground_geom),
       .normal_force =
           force.dot(Eigen::Map<const Vector3d>(contact.frame)) * (first_is_ground ? 1.0 : -1.0),
       .p_W = p_W});
}

MujocoPlant::MujocoPlant(const PlantOptions& options) : world_(std::make_unique<World>(options)) {}
MujocoPlant::~MujocoPlant() = default;

core::SensorReadings MujocoPlant::exchange(const core::JointCommand& command) {
  if (world_->fault.empty()) world_->step(command);
  return world_->delivered;
}

void MujocoPlant::notify_phase(std::optional<core::JumpPhase> phase) {
  world_->pushes.notify_phase(world_->tick, phase);
}

core::Stamp MujocoPlant::now() const {
  return world_->state().stamp;
}

PlantTruth MujocoPlant::truth() const {
  PlantTruth truth;
  truth.state = world_->state();
  truth.X_WF = model::sole_poses(world_->robot, truth.state);
  truth.tau = world_->tau;
  for (int i = 0; i < world_->data->ncon; ++i) world_->add_contact(i, truth);
  for (const core::Leg leg : core::kAllLegs) {
    const std::size_t side = core::index(leg);
    const int first = core::leg_offset(leg);
    const core::LegVector leg_tau = truth.tau.segment<core::kJointsPerLeg>(first);
    const core::LegVector leg_speed = world_->speed_at_tau.segment<core::kJointsPerLeg>(first);
    truth.load[side] = model::motor_load(world_->robot, leg_tau, leg_speed);
    truth.motor_power.segment<core::kJointsPerLeg>(first) =
        model::motor_torques(leg_tau).cwiseProduct(model::motor_speeds(leg_speed));
    truth.state.contact[side] = truth.ground[side].force.z() > kContactForce;
  }
  return truth;
}

std::optional<core::Refusal> MujocoPlant::fault() const {
  if (world_->fault.empty()) return std::nullopt;
  return core::Refusal{.reason = core::Reason::internal_error, .sentence = world_->fault};
}

}  // namespace hopscotch::sim
