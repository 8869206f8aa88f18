#include "sim/mujoco_plant.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "model/gravity.hpp"
#include "model/kinematics.hpp"
#include "model/rigid_body.hpp"
#include "sim/judge.hpp"
#include "sim/random.hpp"

namespace hopscotch::sim {
namespace {

using core::JointVector;
using Eigen::Vector3d;

model::RobotParameters hector() {
  return model::RobotParameters::load(std::string(HOPSCOTCH_SOURCE_DIR) +
                                      "/config/robots/hector.yaml");
}

/// The nominal 45/-90/45 degree posture: whole-body CoM 1.4 mm ahead of the ankles.
StartPosture nominal_posture() {
  StartPosture posture;
  for (const core::Leg leg : core::kAllLegs) {
    posture.q[core::joint_index(leg, core::Joint::hip_pitch)] = M_PI / 4.0;
    posture.q[core::joint_index(leg, core::Joint::knee)] = -M_PI / 2.0;
    posture.q[core::joint_index(leg, core::Joint::ankle)] = M_PI / 4.0;
  }
  return posture;
}

/// On level ground, perfect sensors, exact start; `more` is added to the scenario file.
PlantOptions quiet_options(const std::string& more) {
  PlantOptions options;
  options.scenario = Scenario::from_text(
      "name: test\nslabs: [{x_m: [-3, 3], y_m: [-2, 2]}]\n" + more, "test.yaml");
  options.robot = hector();
  options.posture = nominal_posture();
  options.variation = StartVariation::none();
  return options;
}

constexpr const char* kPerfect = "plant: {sensor_noise: 0, latency_ms: 0}\n";

core::JointCommand hold(const JointVector& q) {
  core::JointCommand command;
  command.mode = core::DriveMode::active;
  command.q = q;
  for (const core::Leg leg : core::kAllLegs) {
    const int first = core::leg_offset(leg);
    command.kp.segment<5>(first) << 150.0, 150.0, 150.0, 150.0, 100.0;
    command.kd.segment<5>(first) << 2.0, 2.0, 2.0, 2.0, 1.0;
  }
  return command;
}

void run(MujocoPlant& plant, const core::JointCommand& command, int ticks) {
  for (int i = 0; i < ticks; ++i) static_cast<void>(plant.exchange(command));
}

double pitch(const PlantTruth& truth) {
  return model::rpy_from_rotation(truth.state.R_WB).y();
}

TEST(MujocoPlant, RobotStandsUnderJointPdAlone) {
  MujocoPlant plant(quiet_options("plant: {sensor_noise: 1.0, latency_ms: 2}\n"));
  double sway = 0.0;
  for (int tick = 0; tick < 3000; ++tick) {
    static_cast<void>(plant.exchange(hold(nominal_posture().q)));
    sway = std::max(sway, std::abs(pitch(plant.truth())));
  }
  EXPECT_FALSE(plant.fault());
  EXPECT_FALSE(fall_of(plant.truth()));
  EXPECT_LT(sway, 0.18);  // 3 to 10 degrees are known for these gains without balance control
  EXPECT_TRUE(plant.truth().state.contact[0] && plant.truth().state.contact[1]);
}

TEST(MujocoPlant, GroundCarriesTheWeightAtRest) {
  PlantOptions options =
      quiet_options("plant: {sensor_noise: 0, latency_ms: 0, mass_scale: 1.1}\n");
  MujocoPlant plant(options);
  constexpr int kSettle = 1500;
  constexpr int kMean = 500;
  run(plant, hold(options.posture.q), kSettle);
  Vector3d force = Vector3d::Zero();
  for (int i = 0; i < kMean; ++i) {
    run(plant, hold(options.posture.q), 1);
    const PlantTruth truth = plant.truth();
    force += (truth.ground[0].force + truth.ground[1].force) / kMean;
  }
  const double weight = 1.1 * hector().total_mass() * model::kGravity;
  EXPECT_NEAR(force.z(), weight, 0.01 * weight);  // slow sway: 1 % of g
  EXPECT_NEAR(force.x(), 0.0, 0.02 * weight);
  EXPECT_NEAR(force.y(), 0.0, 0.01 * weight);
}

TEST(MujocoPlant, LargerInertiasTurnSlowerInTheAir) {
  const auto pitch_after_a_kick = [](const std::string& scale) {
    MujocoPlant plant(quiet_options(
        "start: {drop_m: 2.0}\nplant: {sensor_noise: 0, latency_ms: 0, " + scale + "}\n"));
    core::JointCommand kick;
    kick.mode = core::DriveMode::active;
    for (const core::Leg leg : core::kAllLegs) kick.tau[core::leg_offset(leg) + 2] = 5.0;
    run(plant, kick, 50);
    return std::abs(pitch(plant.truth()));
  };
  const double nominal = pitch_after_a_kick("inertia_scale: 1.0");
  EXPECT_GT(nominal, 0.02);
  EXPECT_LT(pitch_after_a_kick("inertia_scale: 1.5"), 0.95 * nominal);
}

TEST(MujocoPlant, MomentsOfTheGroundPutThePressureUnderTheSole) {
  MujocoPlant plant(quiet_options(kPerfect));
  run(plant, hold(nominal_posture().q), 500);
  const PlantTruth truth = plant.truth();
  for (const core::Wrench& wrench : truth.ground) {
    ASSERT_GT(wrench.force.z(), kContactForce);
    const double pressure_x = -wrench.moment.y() / wrench.force.z();
    EXPECT_LT(std::abs(pressure_x), 0.0755);  // half a sole and the penetration
    EXPECT_LT(std::abs(wrench.moment.x() / wrench.force.z()), 0.002);  // a line foot
  }
}

TEST(MujocoPlant, StartsWithTheSolesAtTheirPlaceAndNothingInTheGround) {
  for (const std::uint64_t seed : {1U, 2U, 3U, 4U, 5U}) {
    PlantOptions options = quiet_options("start: {x_m: 0.4, yaw_rad: 0.7}\n");
    options.variation = StartVariation{};
    options.seed = seed;
    options.posture.trunk_pitch = 0.1;
    const MujocoPlant plant(options);
    const PlantTruth truth = plant.truth();
    const Vector3d middle = 0.5 * (truth.X_WF[0].translation() + truth.X_WF[1].translation());
    EXPECT_NEAR(middle.x(), 0.4, 1e-9);
    EXPECT_NEAR(middle.y(), 0.0, 1e-9);
    EXPECT_NEAR(model::rpy_from_rotation(truth.state.R_WB).z(), 0.7, 1e-9);
    EXPECT_NEAR(pitch(truth), 0.1, 1e-9);
    double lowest = 1.0;
    for (const Eigen::Isometry3d& X_WF : truth.X_WF) {
      const model::SoleTips tips = model::sole_tips(options.robot, X_WF);
      lowest = std::min({lowest, tips.toe.z(), tips.heel.z()});
    }
    EXPECT_NEAR(lowest, 0.0, 1e-9);
  }
}

TEST(MujocoPlant, VariationIsWithinItsBoundsAndDiffersBySeed) {
  PlantOptions options = quiet_options("");
  options.variation = StartVariation{};
  options.seed = 1;
  const core::RobotState first = MujocoPlant(options).truth().state;
  options.seed = 2;
  const core::RobotState second = MujocoPlant(options).truth().state;
  for (const core::RobotState& state : {first, second}) {
    EXPECT_LE((state.q - options.posture.q).cwiseAbs().maxCoeff(), options.variation.joint);
    EXPECT_LE(state.v_WB.cwiseAbs().maxCoeff(), options.variation.velocity);
  }
  EXPECT_NE(first.q, second.q);
  EXPECT_NE(first.v_WB, second.v_WB);
}

TEST(MujocoPlant, StandsOnTheTrueGroundNotOnTheSeenOne) {
  const PlantOptions options = quiet_options("surprises: [{slab: 0, top_m: 0.03}]\n");
  const MujocoPlant plant(options);
  EXPECT_NEAR(plant.truth().X_WF[0].translation().z(), 0.03, 1e-9);
}

/// Free fall from 2 m with the legs thrashing: only gravity acts from outside.
struct Fall {
  PlantOptions options = quiet_options("start: {drop_m: 2.0}\n" + std::string(kPerfect));
  Random random{5};

  core::JointCommand thrash() {
    core::JointCommand command = hold(options.posture.q);
    command.tau = 4.0 * random.uniform_vector<core::kJoints>();
    return command;
  }
};

TEST(MujocoPlant, CentreOfMassFallsOnAParabolaWhateverTheJointsDo) {
  Fall fall;
  MujocoPlant plant(fall.options);
  const model::CompositeBody start = model::composite_body(fall.options.robot, plant.truth().state);
  constexpr int kTicks = 400;
  for (int i = 0; i < kTicks; ++i) run(plant, fall.thrash(), 1);
  const model::CompositeBody end = model::composite_body(fall.options.robot, plant.truth().state);
  const double t = kTicks * 1e-3;
  // The integrator is of first order: g t dt / 2 = 2 mm, and its generalised coordinates let
  // momentum drift by the curvature of the motion within a step.
  EXPECT_NEAR(end.p_WG.z() - start.p_WG.z(), -0.5 * model::kGravity * t * t, 0.003);
  EXPECT_NEAR(end.p_WG.x() - start.p_WG.x(), 0.0, 0.001);
  EXPECT_NEAR(end.v_WG.z(), -model::kGravity * t, 0.005);
  EXPECT_NEAR(end.v_WG.x(), 0.0, 0.005);
  EXPECT_NEAR(end.v_WG.y(), 0.0, 0.005);
}

TEST(MujocoPlant, InternalTorquesLeaveTheAngularMomentumAlone) {
  Fall fall;
  MujocoPlant plant(fall.options);
  double of_the_trunk = 0.0;
  for (int i = 0; i < 400; ++i) {
    run(plant, fall.thrash(), 1);
    const PlantTruth truth = plant.truth();
    const double spin = truth.state.w_WB.norm() * fall.options.robot.trunk.inertia.norm();
    of_the_trunk = std::max(of_the_trunk, spin);
  }
  const model::CompositeBody end = model::composite_body(fall.options.robot, plant.truth().state);
  EXPECT_GT(of_the_trunk, 0.01);  // [N·m·s] the trunk does turn, against the legs
  EXPECT_LT(end.momentum_W.norm(), 0.01 * of_the_trunk);  // error of first-order steps
}

TEST(MujocoPlant, APushChangesTheMomentumByItsImpulse) {
  Fall fall;
  const PlantOptions pushed = quiet_options(
      "start: {drop_m: 2.0}\nsurprises:\n  - {push: {at_s: 0.05, duration_s: 0.1, impulse_Ns: "
      "[4.0, "
      "-2.0, 1.0]}}\n" +
      std::string(kPerfect));
  MujocoPlant reference_plant(fall.options);
  MujocoPlant pushed_plant(pushed);
  const core::JointCommand command = hold(fall.options.posture.q);
  run(reference_plant, command, 200);
  run(pushed_plant, command, 200);
  const model::RobotParameters robot = hector();
  const Vector3d change =
      robot.total_mass() * (model::composite_body(robot, pushed_plant.truth().state).v_WG -
                            model::composite_body(robot, reference_plant.truth().state).v_WG);
  // 1 % for the first-order integration of the turning trunk.
  EXPECT_TRUE(change.isApprox(Vector3d(4.0, -2.0, 1.0), 0.01)) << change.transpose();
}

TEST(MujocoPlant, APushByPhaseStartsWhenTheControllerSaysSo) {
  const PlantOptions options = quiet_options(
      "start: {drop_m: 2.0}\nsurprises:\n  - {push: {phase: flight, after_s: 0.02, duration_s: "
      "0.01, "
      "impulse_Ns: [3.0, 0.0, 0.0]}}\n" +
      std::string(kPerfect));
  MujocoPlant plant(options);
  const core::JointCommand command = hold(options.posture.q);
  const auto speed = [&] {
    return model::composite_body(options.robot, plant.truth().state).v_WG.x();
  };
  run(plant, command, 100);
  plant.notify_phase(core::JumpPhase::flight);
  run(plant, command, 20);
  EXPECT_NEAR(speed(), 0.0, 1e-3);
  run(plant, command, 10);
  EXPECT_NEAR(speed(), 3.0 / options.robot.total_mass(), 5e-3);
}

TEST(MujocoPlant, NoCommandGetsMoreOutOfAMotorThanItHas) {
  constexpr double kRounding = 1e-9;
  PlantOptions options = quiet_options("start: {drop_m: 2.0}\n" + std::string(kPerfect));
  MujocoPlant plant(options);
  Random random(17);
  core::JointCommand command;
  command.mode = core::DriveMode::active;
  LoadPeaks peaks;
  for (int tick = 0; tick < 300; ++tick) {
    // The same huge demand for a while, so that the joints reach their speed limits.
    if (tick % 50 == 0) command.tau = 1000.0 * random.uniform_vector<core::kJoints>();
    run(plant, command, 1);
    peaks.include(plant.truth());
  }
  EXPECT_NEAR(peaks.torque_ratio, 1.0, kRounding);
  EXPECT_LE(peaks.power_ratio, 1.0 + kRounding);
  EXPECT_GT(peaks.power_ratio, 0.5);
  EXPECT_LE(peaks.braking_power, options.robot.braking_power_max + 1e-6);
}

TEST(MujocoPlant, CommandsActExactlyAsManyTicksLaterAsTheLatencySays) {
  for (const int latency : {0, 1, 2, 4}) {
    const PlantOptions options =
        quiet_options("plant: {sensor_noise: 0, latency_ms: " + std::to_string(latency) + "}\n");
    MujocoPlant plant(options);
    core::JointCommand command;
    command.mode = core::DriveMode::active;
    for (int tick = 0; tick < 10; ++tick) {
      command.tau.setConstant(0.1 * (tick + 1));
      run(plant, command, 1);
      const double expected = tick < latency ? 0.0 : 0.1 * (tick - latency + 1);
      EXPECT_NEAR(plant.truth().tau[0], expected, 1e-12) << latency << " at " << tick;
    }
  }
}

TEST(MujocoPlant, AtFiveHundredHertzEverySecondCallExchanges) {
  const PlantOptions options =
      quiet_options("plant: {sensor_noise: 0, latency_ms: 0, exchange_Hz: 500}\n");
  MujocoPlant plant(options);
  core::JointCommand command;
  command.mode = core::DriveMode::active;
  for (int tick = 0; tick < 10; ++tick) {
    command.tau.setConstant(0.1 * (tick + 1));
    const core::SensorReadings readings = plant.exchange(command);
    const int exchanged = tick - tick % 2;
    EXPECT_NEAR(plant.truth().tau[0], 0.1 * (exchanged + 1), 1e-12) << tick;
    EXPECT_EQ(readings.stamp.nanoseconds, (tick + 1 - (tick + 1) % 2) * 1000000) << tick;
  }
}

TEST(MujocoPlant, ReadingsAreThoseOfTheEndOfTheTick) {
  const PlantOptions options = quiet_options(kPerfect);
  MujocoPlant plant(options);
  for (int tick = 0; tick < 50; ++tick) {
    const core::SensorReadings readings = plant.exchange(hold(options.posture.q));
    const PlantTruth truth = plant.truth();
    EXPECT_EQ(readings.stamp, truth.state.stamp);
    EXPECT_EQ(readings.q, truth.state.q);
    EXPECT_EQ(readings.dq, truth.state.dq);
    EXPECT_EQ(readings.tau, truth.tau);
    EXPECT_TRUE(readings.w_WB_B.isApprox(truth.state.R_WB.transpose() * truth.state.w_WB, 1e-12));
  }
}

TEST(MujocoPlant, AccelerometerIntegratesToTheTrunksVelocity) {
  PlantOptions options = quiet_options("start: {yaw_rad: 0.5}\n" + std::string(kPerfect));
  options.posture.trunk_pitch = 0.0;
  MujocoPlant plant(options);
  const Vector3d v_start = plant.truth().state.v_WB;
  Vector3d v = v_start;
  core::JointCommand command = hold(options.posture.q);
  for (int tick = 0; tick < 100; ++tick) {
    // Sits down a little, so that there is something to measure.
    command.q[core::joint_index(core::Leg::left, core::Joint::knee)] -= 0.002;
    command.q[core::joint_index(core::Leg::right, core::Joint::knee)] -= 0.002;
    const core::SensorReadings readings = plant.exchange(command);
    v += 1e-3 * (plant.truth().state.R_WB * readings.f_B - model::kGravity * Vector3d::UnitZ());
  }
  EXPECT_GT((plant.truth().state.v_WB - v_start).norm(), 0.05);
  EXPECT_LT((plant.truth().state.v_WB - v).norm(), 1e-6);
}

TEST(MujocoPlant, WithoutTorqueItCollapsesAndTheFallIsNamed) {
  PlantOptions options = quiet_options("");
  MujocoPlant plant(options);
  run(plant, core::JointCommand{}, 1500);
  const std::optional<std::string> fall = fall_of(plant.truth());
  ASSERT_TRUE(fall);
  EXPECT_FALSE(plant.truth().body_contacts.empty());
  EXPECT_NE(fall->find("touches slab0.top"), std::string::npos) << *fall;
  EXPECT_FALSE(plant.fault());
}

TEST(MujocoPlant, AFootOverThePitFallsIntoIt) {
  PlantOptions options = quiet_options(kPerfect);
  options.scenario.seen.slabs[0].half_size.x() = 0.01;  // pulled away from under the soles
  MujocoPlant plant(options);
  bool in_pit = false;
  for (int tick = 0; tick < 1500 && !in_pit; ++tick) {
    run(plant, hold(options.posture.q), 1);
    in_pit = plant.truth().foot_in_pit;
  }
  EXPECT_TRUE(in_pit);
}

TEST(MujocoPlant, TheSlabsFrictionCountsNotTheLargerOfSoleAndSlab) {
  const auto slid = [](double friction) {
    PlantOptions options = quiet_options(kPerfect);
    options.scenario.seen.slabs[0].slope = 0.25;
    options.scenario.seen.slabs[0].friction = friction;
    for (const core::Leg leg : core::kAllLegs) {
      options.posture.q[core::joint_index(leg, core::Joint::ankle)] -= 0.25;  // soles on the slope
    }
    MujocoPlant plant(options);
    const double before = plant.truth().X_WF[0].translation().x();
    run(plant, hold(options.posture.q), 200);
    return before - plant.truth().X_WF[0].translation().x();
  };
  // Down the slope with g (sin - mu cos): 5 cm after 0.2 s at mu = 0; a third less at mu = 0.08.
  EXPECT_GT(slid(0.08), 0.02);
  EXPECT_LT(slid(0.8), 0.01);
}

/// Everything that a controller or a judge can see of a run with changing commands.
std::vector<double> trace(std::uint64_t seed) {
  PlantOptions options = quiet_options("");
  options.variation = StartVariation{};
  options.seed = seed;
  MujocoPlant plant(options);
  Random random(1);
  std::vector<double> numbers;
  for (int tick = 0; tick < 300; ++tick) {
    core::JointCommand command = hold(options.posture.q);
    command.tau = 5.0 * random.uniform_vector<core::kJoints>();
    const core::SensorReadings readings = plant.exchange(command);
    const PlantTruth truth = plant.truth();
    numbers.insert(numbers.end(), readings.q.begin(), readings.q.end());
    numbers.insert(numbers.end(), readings.f_B.begin(), readings.f_B.end());
    numbers.insert(numbers.end(), truth.state.p_WB.begin(), truth.state.p_WB.end());
    numbers.push_back(truth.ground[0].force.z());
  }
  return numbers;
}

TEST(MujocoPlant, TheSameSeedGivesTheSameBits) {
  EXPECT_EQ(trace(4), trace(4));
  EXPECT_NE(trace(4), trace(5));
}

TEST(MujocoPlant, ACommandThatIsNoNumberEndsInAFaultAndStopsTheWorld) {
  PlantOptions options = quiet_options(kPerfect);
  MujocoPlant plant(options);
  run(plant, hold(options.posture.q), 10);
  EXPECT_FALSE(plant.fault());
  core::JointCommand broken = hold(options.posture.q);
  broken.tau[3] = core::kNaN;
  run(plant, broken, 1);
  ASSERT_TRUE(plant.fault());
  EXPECT_EQ(plant.fault()->reason, core::Reason::internal_error);
  EXPECT_NE(plant.fault()->sentence.find("MuJoCo"), std::string::npos);
  const core::Stamp stopped = plant.now();
  run(plant, hold(options.posture.q), 5);
  EXPECT_EQ(plant.now(), stopped);
}

}  // namespace
}  // namespace hopscotch::sim
