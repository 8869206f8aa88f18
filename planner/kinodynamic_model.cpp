#include "model/kinematics.hpp"
#include "model/rigid_body.hpp"
#include "planner/flight_phase.hpp"
#include "planner/formulation.hpp"
#include "planner/kinodynamic_laws.hpp"
#include "planner/leg_statics.hpp"
#include "planner/motion_sampler.hpp"
#include "planner/program_builder.hpp"

namespace hopscotch::planner {

namespace {

// A hundred steps, as the source's comparison has.
constexpr int kTakeoffSteps = 50;
constexpr int kFlightSteps = 20;
constexpr int kLandingSteps = 30;
constexpr double kTakeoffStep = 0.01;           // [s]
constexpr ValueRange kFlightStep{2e-3, 0.03};   // [s]
constexpr ValueRange kLandingStep{5e-3, 0.03};  // [s]
// Keep the search sane.
constexpr double kForceMax = 1000.0;  // of one foot [N]
constexpr double kMomentMax = 100.0;  // [N·m]
constexpr double kTiltMax = 1.2;      // [rad]
constexpr double kTypicalForce = 50.0;
constexpr double kTypicalMoment = 5.0;
constexpr double kTwistRadius = 0.02;  // [m]
// Costs.
constexpr double kTorqueCost = 2e-4;       // [1/(N·m)^2]
constexpr double kPostureCost = 0.02;      // [1/rad^2]
constexpr double kChangeCost = 5.0;        // [1/rad^2]
constexpr double kForceChangeCost = 1e-4;  // [1/N^2]

using Leg5 = std::array<int, 5>;

struct Knot {
  std::array<int, 3> p{};  ///< CoM.
  std::array<int, 3> rpy{};
  std::array<int, 3> v{};
  std::array<int, 3> w{};
  std::array<Leg5, 2> q{};
  std::array<Leg5, 2> effort{};  ///< Of the step that follows; none in flight.
};

class KinodynamicProgram {
 public:
  KinodynamicProgram(const PlanarModel& model, const PlanarTask& task)
      : model_(model),
        task_(task),
        guess_(model, task),
        legs_{LegChain(model.robot, core::Leg::left), LegChain(model.robot, core::Leg::right)} {
    take_body();
    add_knots();
    add_steps();
  }

  FormulatedJump solve(const SolveOptions& options) {
    FormulatedJump jump;
    jump.variables = program_.variables();
    jump.outcome = program_.solve(options, jump.rows);
    jump.motion = read(jump.outcome.x);
    return jump;
  }

 private:
  static constexpr int kSteps = kTakeoffSteps + kFlightSteps + kLandingSteps;

  [[nodiscard]] static core::JumpPhase phase_of(int k) {
    if (k < kTakeoffSteps) return core::JumpPhase::takeoff;
    return k < kTakeoffSteps + kFlightSteps ? core::JumpPhase::flight : core::JumpPhase::landing;
  }
  [[nodiscard]] int length_of(int k) const {
    if (k < kTakeoffSteps) return takeoff_step_;
    return k < kTakeoffSteps + kFlightSteps ? flight_step_ : landing_step_;
  }
  /// Guess at knot `k`; the takeoff's crouch is cut to this formulation's time.
  [[nodiscard]] PlanarInstant guessed(int k) const {
    if (k == 0) return guess_.at(core::JumpPhase::takeoff, 0.0);
    if (k <= kTakeoffSteps) {
      const double left = kTakeoffStep * (kTakeoffSteps - k);
      const double whole = guess_.duration(core::JumpPhase::takeoff);
      return guess_.at(core::JumpPhase::takeoff, 1.0 - left / whole);
    }
    const int in_flight = k - kTakeoffSteps;
    if (in_flight < kFlightSteps) {
      return guess_.at(core::JumpPhase::flight, static_cast<double>(in_flight) / kFlightSteps);
    }
    return guess_.at(core::JumpPhase::landing,
                     static_cast<double>(in_flight - kFlightSteps) / kLandingSteps);
  }

  /// Inertia and CoM of the robot in its final posture, from then on rigid.
  void take_body() {
    const PlanarInstant end = guess_.at(core::JumpPhase::landing, 1.0);
    core::RobotState state;
    const model::PlanarVector<double> r = model_.dynamics.trunk_origin(end.links.pitch);
    state.p_WB = {end.ankle.x + r.x, 0.0, end.ankle.z + r.z};
    state.R_WB = model::rotation_from_rpy({0.0, end.links.pitch[model::kTrunk], 0.0});
    state.v_WB.setZero();
    state.w_WB.setZero();
    state.dq.setZero();
    const std::array<double, 5> q = joints_of(end.links);
    for (const core::Leg leg : core::kAllLegs) {
      for (int i = 0; i < 5; ++i) {
        state.q(core::leg_offset(leg) + i) = q[static_cast<std::size_t>(i)];
      }
    }
    const model::CompositeBody body = model::composite_body(model_.robot, state);
    mass_ = body.mass;
    inertia_ = body.inertia_W.diagonal();
    com_B_ = state.R_WB.transpose() * (body.p_WG - state.p_WB);
  }

  [[nodiscard]] static std::array<double, 5> joints_of(const LinkState& links) {
    return joints_of(links.pitch);
  }
  [[nodiscard]] static std::array<double, 5> joints_of(const model::LinkArray<double>& a) {
    const model::PlanarJoints<double> q = model::joints_from_links(a);
    return {0.0, 0.0, q.hip, q.knee, q.ankle};
  }

  void add_knots() {
    takeoff_step_ = program_.add_constant(kTakeoffStep);
    flight_step_ = program_.add_variable(guess_.duration(core::JumpPhase::flight) / kFlightSteps,
                                         kFlightStep, 0.01);
    landing_step_ = program_.add_variable(guess_.duration(core::JumpPhase::landing) / kLandingSteps,
                                          kLandingStep, 0.01);
    for (int k = 0; k <= kSteps; ++k) knots_.push_back(add_knot(k));
    for (const auto& [at, k] : {std::pair{&knots_.front(), 0}, std::pair{&knots_.back(), kSteps}}) {
      const Body body = body_at(k);
      for (std::size_t i = 0; i < 3; ++i) {
        const auto d = static_cast<Eigen::Index>(i);
        program_.fix(at->p[i], body.p(d));
        program_.fix(at->rpy[i], body.rpy(d));
        program_.fix(at->v[i], 0.0);
        program_.fix(at->w[i], 0.0);
      }
    }
  }

  struct Body {
    Eigen::Vector3d p;
    Eigen::Vector3d rpy;
  };
  [[nodiscard]] Body body_at(int k) const {
    const PlanarInstant now = guessed(k);
    const model::PlanarVector<double> r = model_.dynamics.trunk_origin(now.links.pitch);
    const Eigen::Vector3d rpy(0.0, now.links.pitch[model::kTrunk], 0.0);
    const Eigen::Vector3d p_SB(now.ankle.x + r.x, 0.0, now.ankle.z + r.z);
    return {p_SB + model::rotation_from_rpy(rpy) * com_B_, rpy};
  }

  [[nodiscard]] Knot add_knot(int k) {
    const PlanarInstant now = guessed(k);
    const Body body = body_at(k);
    const model::PlanarVector<double> r =
        model_.dynamics.com_velocity(now.links.pitch, now.links.rate);
    const Eigen::Vector3d v(now.ankle_velocity.x + r.x, 0.0, now.ankle_velocity.z + r.z);
    const Eigen::Vector3d w(0.0, now.links.rate[model::kTrunk], 0.0);
    Knot knot;
    for (std::size_t i = 0; i < 3; ++i) {
      const auto d = static_cast<Eigen::Index>(i);
      knot.p[i] = program_.add_variable(body.p(d), {});
      knot.rpy[i] = program_.add_variable(body.rpy(d), {-kTiltMax, kTiltMax});
      knot.v[i] = program_.add_variable(v(d), {-10.0, 10.0}, 2.0);
      knot.w[i] = program_.add_variable(w(d), {-40.0, 40.0}, 5.0);
    }
    const std::array<double, 5> q = joints_of(now.links);
    for (const core::Leg leg : core::kAllLegs) {
      for (std::size_t i = 0; i < 5; ++i) {
        const model::JointRange range =
            model::joint_range(model_.robot, leg, static_cast<core::Joint>(i));
        knot.q[core::index(leg)][i] = program_.add_variable(q[i], {range.lower, range.upper});
      }
      if (k < kSteps && phase_of(k) != core::JumpPhase::flight) {
        knot.effort[core::index(leg)] = add_effort();
      }
    }
    return knot;
  }
  [[nodiscard]] Leg5 add_effort() {
    const ValueRange force{-kForceMax, kForceMax};
    const ValueRange moment{-kMomentMax, kMomentMax};
    const double share = 0.5 * mass_ * model::kGravity;
    return {program_.add_variable(0.0, force, kTypicalForce),
            program_.add_variable(0.0, force, kTypicalForce),
            program_.add_variable(share, {0.0, kForceMax}, kTypicalForce),
            program_.add_variable(0.0, moment, kTypicalMoment),
            program_.add_variable(0.0, moment, kTypicalMoment)};
  }

  void add_steps() {
    for (int k = 0; k < kSteps; ++k) {
      const Knot& from = knots_[static_cast<std::size_t>(k)];
      const Knot& to = knots_[static_cast<std::size_t>(k) + 1];
      add_body_step(k, from, to);
      for (std::size_t leg = 0; leg < 2; ++leg) {
        add_joint_rates(from.q[leg], to.q[leg], length_of(k));
        if (phase_of(k) != core::JumpPhase::flight) add_foot_effort(from, leg);
      }
      add_soles(k + 1, to);
    }
    add_soles(0, knots_.front());
    for (int k = 0; k + 1 < kSteps; ++k) {
      if (phase_of(k) == core::JumpPhase::flight || phase_of(k + 1) != phase_of(k)) continue;
      for (std::size_t leg = 0; leg < 2; ++leg) {
        for (std::size_t i = 0; i < 3; ++i) {
          program_.add(ForceChangeLaw{kForceChangeCost},
                       std::array<int, 2>{knots_[static_cast<std::size_t>(k)].effort[leg][i],
                                          knots_[static_cast<std::size_t>(k) + 1].effort[leg][i]});
        }
      }
    }
  }

  void add_body_step(int k, const Knot& from, const Knot& to) {
    const int h = length_of(k);
    const bool flight = phase_of(k) == core::JumpPhase::flight;
    if (flight && nothing_ < 0) nothing_ = program_.add_constant(0.0);
    Leg5 none;
    none.fill(nothing_);
    const Leg5& left = flight ? none : from.effort[0];
    const Leg5& right = flight ? none : from.effort[1];
    for (std::size_t i = 0; i < 3; ++i) {
      program_.add(MeanVelocityLaw{},
                   std::array<int, 5>{from.p[i], to.p[i], from.v[i], to.v[i], h});
      program_.add(BodyForceLaw{mass_, i == 2 ? model::kGravity : 0.0},
                   std::array<int, 5>{from.v[i], to.v[i], left[i], right[i], h});
    }
    const std::array<int, 1> length{h};
    program_.add(BodyMomentLaw{inertia_, soles(phase_of(k))},
                 joined(from.w, to.w, from.p, left, right, length));
    program_.add(AttitudeLaw{}, joined(from.rpy, to.rpy, to.w, length));
  }
  [[nodiscard]] std::array<Eigen::Vector3d, 2> soles(core::JumpPhase phase) const {
    const bool landed = phase == core::JumpPhase::landing;
    std::array<Eigen::Vector3d, 2> out;
    for (const core::Leg leg : core::kAllLegs) {
      const double y =
          model::leg_poses(model_.robot, leg, core::LegVector::Zero()).X_BF.translation().y();
      out[core::index(leg)] = {landed ? task_.distance : 0.0, y, landed ? task_.height : 0.0};
    }
    return out;
  }
  void add_joint_rates(const Leg5& from, const Leg5& to, int h) {
    const std::array<double, 5> posture = joints_of(task_.final_posture);
    for (std::size_t i = 0; i < 5; ++i) {
      program_.add(
          JointRateLaw{model_.robot.motors[i].speed_max, posture[i], kPostureCost, kChangeCost},
          std::array<int, 3>{from[i], to[i], h});
    }
  }
  void add_foot_effort(const Knot& knot, std::size_t leg) {
    FootEffortLaw law{legs_[leg]};
    for (std::size_t i = 0; i < 5; ++i) law.torque_max[i] = model_.robot.motors[i].torque_max;
    law.friction = model_.config.reserves.friction * model_.config.friction;
    law.half_length =
        0.5 * (model_.robot.toe + model_.robot.heel) - model_.config.takeoff_cop_margin;
    law.twist_radius = kTwistRadius;
    law.weight = mass_ * model::kGravity;
    law.torque_cost = kTorqueCost;
    program_.add(law, joined(knot.rpy, knot.q[leg], knot.effort[leg]));
  }
  /// The soles of knot `k`: on the ground, or in the air above it.
  void add_soles(int k, const Knot& knot) {
    const bool air = k > kTakeoffSteps && k < kTakeoffSteps + kFlightSteps;
    const std::array<Eigen::Vector3d, 2> places =
        soles(k <= kTakeoffSteps ? core::JumpPhase::takeoff : core::JumpPhase::landing);
    const double share = static_cast<double>(k - kTakeoffSteps) / kFlightSteps;
    for (std::size_t leg = 0; leg < 2; ++leg) {
      const double clearance = air ? clearance_profile(task_.clearance, share) : core::kNaN;
      program_.add(SoleLaw{legs_[leg], com_B_, places[leg], task_.terrain, clearance},
                   joined(knot.p, knot.rpy, knot.q[leg]));
    }
  }

  [[nodiscard]] PlanarMotion read(const Eigen::VectorXd& x) const {
    PlanarMotion motion;
    for (int k = 0; k <= kSteps; ++k) {
      const Knot& at = knots_[static_cast<std::size_t>(k)];
      const auto mean = [&](std::size_t joint) {
        return 0.5 * (x(at.q[0][joint]) + x(at.q[1][joint]));
      };
      PlanarKnot knot;
      knot.phase = phase_of(std::min(k, kSteps - 1));
      knot.dt = k < kSteps ? x(length_of(k)) : 0.0;
      const double trunk = x(at.rpy[1]);
      const double thigh = trunk + mean(2);
      const double shank = thigh + mean(3);
      knot.links.pitch = {shank + mean(4), shank, thigh, trunk};
      const Eigen::Vector3d rpy(x(at.rpy[0]), trunk, x(at.rpy[2]));
      const Eigen::Vector3d p_SB = Eigen::Vector3d(x(at.p[0]), x(at.p[1]), x(at.p[2])) -
                                   model::rotation_from_rpy(rpy) * com_B_;
      const model::PlanarVector<double> r = model_.dynamics.trunk_origin(knot.links.pitch);
      knot.promised.emplace().ankle = {p_SB.x() - r.x, p_SB.z() - r.z};
      motion.knots.push_back(knot);
    }
    add_rates_by_differences(motion);
    complete_motion(model_, task_, motion);
    for (int k = 0; k < kSteps; ++k) promise(k, x, motion);
    return motion;
  }
  void promise(int k, const Eigen::VectorXd& x, PlanarMotion& motion) const {
    PlanarKnot& knot = motion.knots[static_cast<std::size_t>(k)];
    if (knot.phase == core::JumpPhase::flight) return;
    PromisedStep& promised = *knot.promised;
    const Knot& at = knots_[static_cast<std::size_t>(k)];
    double about_sole = 0.0;
    for (const Leg5& effort : at.effort) {
      promised.force.x += x(effort[0]);
      promised.force.z += x(effort[2]);
      about_sole += x(effort[3]);
    }
    // From the sole's centre to the ankle axis.
    const double sole_height = model_.dynamics.chain().sole_height;
    promised.moment =
        about_sole - sole_height * promised.force.x + model_.ankle_x() * promised.force.z;
    promised.tau =
        static_torques(model_.dynamics.chain(), knot.links.pitch, promised.force, promised.moment);
  }

  const PlanarModel& model_;
  const PlanarTask& task_;
  MotionSampler guess_;
  std::array<LegChain, 2> legs_;
  double mass_ = 0.0;
  Eigen::Vector3d inertia_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d com_B_ = Eigen::Vector3d::Zero();
  ProgramBuilder program_;
  std::vector<Knot> knots_;
  int takeoff_step_ = 0;
  int flight_step_ = 0;
  int landing_step_ = 0;
  int nothing_ = -1;  ///< A constant zero: the effort of a foot in the air.
};

}  // namespace

FormulatedJump solve_kinodynamic(const PlanarModel& model, const PlanarTask& task,
                                 const SolveOptions& options) {
  return KinodynamicProgram(model, task).solve(options);
}

}  // namespace hopscotch::planner
