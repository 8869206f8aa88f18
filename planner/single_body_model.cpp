#include <algorithm>
#include <cmath>

#include "model/stand_posture.hpp"
#include "planner/formulation.hpp"
#include "planner/leg_statics.hpp"
#include "planner/motion_sampler.hpp"
#include "planner/program_builder.hpp"
#include "planner/shared_limits.hpp"

namespace hopscotch::planner {

namespace {

constexpr int kTakeoffSteps = 50;
constexpr int kFlightSteps = 20;
constexpr int kLandingSteps = 30;
constexpr double kTakeoffTime = 0.5;  // [s]
constexpr double kForceMax = 2000.0;  // keeps the search sane [N]
constexpr double kTypicalForce = 100.0;
// Cost on forces as shares of the weight, on the state's distance from the guess, on rates.
constexpr double kForceCost = 0.02;
constexpr double kPlaceCost = 5.0;
constexpr double kPitchCost = 1.0;
constexpr double kRateCost = 0.1;
/// Where the CoM may be from the ankle axis: what the legs reach, as a box [m].
constexpr ValueRange kAhead{-0.12, 0.12};
constexpr ValueRange kAbove{0.24, 0.43};

/// One rigid body over a step with constant force, lever arm as guessed: eqs. (5), (6), linear.
/// Variables: x, z, pitch, vx, vz, pitch rate at both knots, F, M.
struct RigidStepLaw {
  static constexpr int kRows = 6 + GroundRows::kRows;
  double mass = 0.0;
  double inertia = 0.0;
  double step = 0.0;                    ///< [s]
  model::PlanarVector<double> lever{};  ///< Ankle axis from the CoM [m].
  model::PlanarVector<double> place{};  ///< Of the CoM, guessed [m].
  double pitch = 0.0;                   ///< [rad]
  GroundRows ground;

  template <typename T>
  T operator()(const std::array<T, 15>& x, std::array<T, kRows>& rows) const {
    const T& fx = x[12];
    const T& fz = x[13];
    const T& moment = x[14];
    const std::array<T, 3> acceleration{fx * (1.0 / mass), fz * (1.0 / mass) - model::kGravity,
                                        (lever.z * fx - lever.x * fz + moment) * (1.0 / inertia)};
    for (std::size_t i = 0; i < 3; ++i) {
      rows[i] = x[6 + i] - x[i] - step * x[3 + i] - (0.5 * step * step) * acceleration[i];
      rows[3 + i] = x[9 + i] - x[3 + i] - step * acceleration[i];
    }
    const T zero = T(0.0);
    ground.write(model::StanceLoads<T>{{zero, zero, zero}, {fx, fz}, moment}, rows.data() + 6);
    const double share = 1.0 / ground.weight;
    const T dx = x[0] - place.x;
    const T dz = x[1] - place.z;
    const T turn = x[2] - pitch;
    const T lift = fz * share - 1.0;
    const T along = fx * share;
    const T twist = moment * share;
    return kForceCost * (lift * lift + along * along + twist * twist) +
           kPlaceCost * (dx * dx + dz * dz) + kPitchCost * (turn * turn) +
           kRateCost * (x[5] * x[5]);
  }
  void bounds(std::span<double> lower, std::span<double> upper) const {
    std::fill_n(lower.begin(), 6, 0.0);
    std::fill_n(upper.begin(), 6, 0.0);
    ground.bounds(lower.subspan(6), upper.subspan(6));
  }
};

/// The whole flight at once: a parabola and a constant pitch rate. Variables as before, without
/// force.
struct RigidFlightLaw {
  static constexpr int kRows = 6;
  double time = 0.0;  ///< [s]

  template <typename T>
  T operator()(const std::array<T, 12>& x, std::array<T, kRows>& rows) const {
    for (std::size_t i = 0; i < 3; ++i) {
      rows[i] = x[6 + i] - x[i] - time * x[3 + i];
      rows[3 + i] = x[9 + i] - x[3 + i];
    }
    return T(0.0);
  }
  void bounds(std::span<double> lower, std::span<double> upper) const {
    std::fill_n(lower.begin(), kRows, 0.0);
    lower[1] = -0.5 * model::kGravity * time * time;
    lower[4] = -model::kGravity * time;
    std::copy_n(lower.begin(), kRows, upper.begin());
  }
};

/// A body at one instant.
struct Body {
  model::PlanarVector<double> place;
  double pitch;
  model::PlanarVector<double> velocity;
  double rate;
};

class RigidProgram {
 public:
  RigidProgram(const PlanarModel& model, const PlanarTask& task)
      : model_(model),
        task_(task),
        guess_(model, task),
        ground_(ground_rows(model.dynamics.chain(), model.config, 0.0)) {
    model::LinkArray<double> as_one{};
    as_one.fill(1.0);
    inertia_ = model.dynamics.centroidal_momentum(task.final_posture, as_one);
    flight_time_ = guess_.duration(core::JumpPhase::flight);
    landing_step_ = guess_.duration(core::JumpPhase::landing) / kLandingSteps;
    takeoff_ = add_stance(core::JumpPhase::takeoff, kTakeoffSteps, kTakeoffTime / kTakeoffSteps);
    landing_ = add_stance(core::JumpPhase::landing, kLandingSteps, landing_step_);
    program_.add(RigidFlightLaw{flight_time_},
                 joined(consecutive<6>(takeoff_.back()), consecutive<6>(landing_.front())));
    fix(takeoff_.front(), guess_.at(core::JumpPhase::takeoff, 0.0));
    fix(landing_.back(), guess_.at(core::JumpPhase::landing, 1.0));
  }

  FormulatedJump solve(const SolveOptions& options) {
    FormulatedJump jump;
    jump.variables = program_.variables();
    jump.outcome = program_.solve(options, jump.rows);
    jump.motion = read(jump.outcome.x);
    return jump;
  }

 private:
  [[nodiscard]] Body body_of(const PlanarInstant& now) const {
    const model::PlanarVector<double> r = model_.dynamics.com(now.links.pitch);
    const model::PlanarVector<double> v =
        model_.dynamics.com_velocity(now.links.pitch, now.links.rate);
    return {{now.ankle.x + r.x, now.ankle.z + r.z},
            now.links.pitch[model::kTrunk],
            {now.ankle_velocity.x + v.x, now.ankle_velocity.z + v.z},
            now.links.rate[model::kTrunk]};
  }
  void fix(int at, const PlanarInstant& now) {
    const Body body = body_of(now);
    const std::array<double, 6> values{body.place.x,    body.place.z,    body.pitch,
                                       body.velocity.x, body.velocity.z, body.rate};
    for (int i = 0; i < 6; ++i) program_.fix(at + i, values[static_cast<std::size_t>(i)]);
  }
  /// The guess, with the takeoff's crouch cut to this formulation's time.
  [[nodiscard]] PlanarInstant guessed(core::JumpPhase phase, double share) const {
    if (phase != core::JumpPhase::takeoff || share == 0.0) return guess_.at(phase, share);
    const double whole = guess_.duration(phase);
    return guess_.at(phase, 1.0 - (1.0 - share) * kTakeoffTime / whole);
  }
  std::vector<int> add_stance(core::JumpPhase phase, int steps, double step) {
    std::vector<int> knots;
    for (int k = 0; k <= steps; ++k) {
      const PlanarInstant now = guessed(phase, static_cast<double>(k) / steps);
      const Body body = body_of(now);
      knots.push_back(program_.add_variable(
          body.place.x, {now.ankle.x + kAhead.lower, now.ankle.x + kAhead.upper}));
      (void)program_.add_variable(body.place.z,
                                  {now.ankle.z + kAbove.lower, now.ankle.z + kAbove.upper});
      (void)program_.add_variable(body.pitch,
                                  {model_.config.trunk_pitch_min, model_.config.trunk_pitch_max});
      (void)program_.add_variable(body.velocity.x, {});
      (void)program_.add_variable(body.velocity.z, {});
      (void)program_.add_variable(body.rate, {});
    }
    for (int k = 0; k < steps; ++k) {
      const PlanarInstant now = guessed(phase, (k + 0.5) / steps);
      const Body body = body_of(now);
      const model::PlanarVector<double> lever{now.ankle.x - body.place.x,
                                              now.ankle.z - body.place.z};
      const ValueRange range{-kForceMax, kForceMax};
      const std::array<int, 3> force{program_.add_variable(now.force.x, range, kTypicalForce),
                                     program_.add_variable(now.force.z, range, kTypicalForce),
                                     program_.add_variable(now.moment, range, kTypicalForce)};
      const auto at = static_cast<std::size_t>(k);
      program_.add(RigidStepLaw{model_.dynamics.chain().total_mass(), inertia_, step, lever,
                                body.place, body.pitch, ground_},
                   joined(consecutive<6>(knots[at]), consecutive<6>(knots[at + 1]), force));
      forces_.push_back(force);
    }
    return knots;
  }

  /// Legs that put the CoM there; where they do not reach, nearest.
  [[nodiscard]] model::LinkArray<double> legs(model::PlanarVector<double> com, double pitch) const {
    constexpr double kShrink = 0.98;
    const model::PlanarVector<double> near{0.0, 0.33};
    for (int attempt = 0; attempt < 50; ++attempt) {
      const auto links = model::links_from_com(model_.dynamics, com, {0.0, 0.0, 0.0, pitch});
      if (links) return *links;
      com = {near.x + kShrink * (com.x - near.x), near.z + kShrink * (com.z - near.z)};
    }
    return task_.final_posture;
  }

  [[nodiscard]] PlanarMotion read(const Eigen::VectorXd& x) const {
    PlanarMotion motion;
    const auto append = [&](core::JumpPhase phase, double dt, const Body& body,
                            const model::PlanarVector<double>& ankle) {
      PlanarKnot knot;
      knot.phase = phase;
      knot.dt = dt;
      knot.links.pitch = legs({body.place.x - ankle.x, body.place.z - ankle.z}, body.pitch);
      knot.promised.emplace().ankle = ankle;
      motion.knots.push_back(knot);
    };
    const auto body_at = [&x](int at) {
      return Body{{x(at), x(at + 1)}, x(at + 2), {x(at + 3), x(at + 4)}, x(at + 5)};
    };
    const model::PlanarVector<double> start = guess_.motion().start_ankle;
    const model::PlanarVector<double> target = guess_.motion().target_ankle;
    for (int k = 0; k < kTakeoffSteps; ++k) {
      append(core::JumpPhase::takeoff, kTakeoffTime / kTakeoffSteps,
             body_at(takeoff_[static_cast<std::size_t>(k)]), start);
    }
    for (int k = 0; k < kFlightSteps; ++k) {
      Body body = body_at(takeoff_.back());
      const double share = static_cast<double>(k) / kFlightSteps;
      const double t = share * flight_time_;
      body.place.x += t * body.velocity.x;
      body.place.z += t * (body.velocity.z - 0.5 * model::kGravity * t);
      body.pitch += t * body.rate;
      append(core::JumpPhase::flight, flight_time_ / kFlightSteps, body,
             guess_.at(core::JumpPhase::flight, share).ankle);
    }
    for (int k = 0; k < kLandingSteps; ++k) {
      append(core::JumpPhase::landing, landing_step_,
             body_at(landing_[static_cast<std::size_t>(k)]), target);
    }
    append(core::JumpPhase::landing, 0.0, body_at(landing_.back()), target);
    add_rates_by_differences(motion);
    complete_motion(model_, task_, motion);
    promise(x, motion);
    return motion;
  }
  void promise(const Eigen::VectorXd& x, PlanarMotion& motion) const {
    std::size_t step = 0;
    for (PlanarKnot& knot : motion.knots) {
      if (knot.phase == core::JumpPhase::flight || knot.dt == 0.0) continue;
      const std::array<int, 3>& force = forces_[step++];
      knot.promised->force = {x(force[0]), x(force[1])};
      knot.promised->moment = x(force[2]);
      knot.promised->tau = static_torques(model_.dynamics.chain(), knot.links.pitch,
                                          knot.promised->force, knot.promised->moment);
    }
  }

  const PlanarModel& model_;
  const PlanarTask& task_;
  MotionSampler guess_;
  GroundRows ground_;
  double inertia_ = 0.0;
  double flight_time_ = 0.0;
  double landing_step_ = 0.0;
  ProgramBuilder program_;
  std::vector<int> takeoff_;  ///< First variable of each knot.
  std::vector<int> landing_;
  std::vector<std::array<int, 3>> forces_;
};

}  // namespace

FormulatedJump solve_single_body(const PlanarModel& model, const PlanarTask& task,
                                 const SolveOptions& options) {
  return RigidProgram(model, task).solve(options);
}

}  // namespace hopscotch::planner
