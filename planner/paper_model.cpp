#include "planner/flight_phase.hpp"
#include "planner/formulation.hpp"
#include "planner/motion_sampler.hpp"
#include "planner/paper_laws.hpp"
#include "planner/program_builder.hpp"

namespace hopscotch::planner {

namespace {

// Steps as printed.
constexpr int kTakeoffSteps = 70;
constexpr int kFlightSteps = 30;
constexpr int kLandingSteps = 30;
constexpr double kTakeoffStep = 0.01;           // dt^t [s]
constexpr ValueRange kFlightStep{1e-3, 0.03};   // dt^f; its lower end is printed as 0 [s]
constexpr ValueRange kLandingStep{0.02, 0.05};  // dt^l [s]
constexpr double kVirtualForceMax = 10.0;       // |F_v| along each axis [N]
constexpr double kForceMax = 2000.0;            // none is printed; keeps the search sane [N]
constexpr double kMomentMax = 300.0;            // the same [N·m]
constexpr double kRateMax = 40.0;               // the same [rad/s]
constexpr double kTypicalForce = 100.0;         // [N]
constexpr double kTypicalRate = 5.0;            // [rad/s]

/// Where a knot's variables are; a step's force follows its first knot.
struct Knot {
  std::array<int, 3> y{};      ///< Shank, knee, trunk.
  std::array<int, 3> v{};      ///< Their rates.
  std::array<int, 2> place{};  ///< Of the trunk CoM.
  std::array<int, 2> velocity{};
  std::array<int, 3> force{};  ///< F (or F_v) and M.
};

class PaperProgram {
 public:
  PaperProgram(const PlanarModel& model, const PlanarTask& task)
      : model_(model),
        task_(task),
        guess_(model, task),
        robot_{model.dynamics, motor_limits(model.robot, Reserves{1.0, 1.0, 1.0, 1.0}),
               ground_rows(model.dynamics.chain(), model.config, 0.0),
               PaperCost{.reference = model::joints_from_links(task.final_posture)}} {
    robot_.ground.friction = model.config.friction;
    robot_.ground.normal_force_min = 0.0;
    robot_.ground.normal_force_max = kForceMax;
    add_takeoff();
    add_flight();
    add_landing();
  }

  FormulatedJump solve(const SolveOptions& options) {
    FormulatedJump jump;
    jump.variables = program_.variables();
    jump.outcome = program_.solve(options, jump.rows);
    jump.motion = read(jump.outcome.x);
    return jump;
  }

 private:
  [[nodiscard]] std::array<int, 3> add_posture(const LinkState& links) {
    const auto y = coordinates_from_links(links.pitch);
    const model::JointRange knee =
        model::joint_range(model_.robot, core::Leg::left, core::Joint::knee);
    const double shank = model_.config.shank_pitch_max;
    return {program_.add_variable(y[0], {-shank, shank}),
            program_.add_variable(y[1], {knee.lower, knee.upper}),
            program_.add_variable(y[2], {-shank, shank})};
  }
  [[nodiscard]] std::array<int, 3> add_rates(const LinkState& links) {
    const auto v = coordinates_from_links(links.rate);
    std::array<int, 3> at{};
    for (std::size_t i = 0; i < at.size(); ++i) {
      at[i] = program_.add_variable(v[i], {-kRateMax, kRateMax}, kTypicalRate);
    }
    return at;
  }
  [[nodiscard]] std::array<int, 3> add_force(const PlanarInstant& now, double most) {
    const ValueRange range{-most, most};
    const double moment = most > kVirtualForceMax ? kMomentMax : 0.0;
    return {program_.add_variable(now.force.x, range, kTypicalForce),
            program_.add_variable(now.force.z, range, kTypicalForce),
            program_.add_variable(now.moment, {-moment, moment}, kTypicalForce)};
  }
  void add_trunk(const PlanarInstant& now, Knot& knot) {
    const model::PlanarChain& chain = model_.dynamics.chain();
    const model::PlanarVector<double> r = trunk_com(chain, now.links.pitch);
    const model::PlanarVector<double> v =
        trunk_com_velocity(chain, now.links.pitch, now.links.rate);
    knot.place = {program_.add_variable(now.ankle.x + r.x, {}),
                  program_.add_variable(now.ankle.z + r.z, {})};
    knot.velocity = {program_.add_variable(now.ankle_velocity.x + v.x, {}),
                     program_.add_variable(now.ankle_velocity.z + v.z, {})};
  }
  void fix_state(const Knot& knot, const LinkState& state) {
    const auto y = coordinates_from_links(state.pitch);
    const auto v = coordinates_from_links(state.rate);
    for (std::size_t i = 0; i < 3; ++i) {
      program_.fix(knot.y[i], y[i]);
      program_.fix(knot.v[i], v[i]);
    }
  }
  void add_joint_limits(const Knot& knot) {
    PlannerConfig config = model_.config;
    config.reserves = {1.0, 1.0, 1.0, 1.0};
    config.joint_margin = 0.0;
    program_.add(joint_rows<kStanceDof>(model_.robot, config), joined(knot.y, knot.v));
  }
  void add_joint_euler(const Knot& from, const Knot& to, int step) {
    for (std::size_t i = 0; i < 3; ++i) {
      program_.add(EulerLaw{}, std::array<int, 4>{from.y[i], from.v[i], to.y[i], step});
    }
  }
  void add_trunk_euler(const Knot& from, const Knot& to, int step) {
    for (std::size_t i = 0; i < 2; ++i) {
      program_.add(EulerLaw{},
                   std::array<int, 4>{from.place[i], from.velocity[i], to.place[i], step});
    }
  }

  void add_takeoff() {
    takeoff_step_ = program_.add_constant(kTakeoffStep);
    for (int k = 0; k <= kTakeoffSteps; ++k) {
      const PlanarInstant now =
          guess_.at(core::JumpPhase::takeoff, static_cast<double>(k) / kTakeoffSteps);
      Knot knot;
      knot.y = add_posture(now.links);
      knot.v = add_rates(now.links);
      if (k < kTakeoffSteps) knot.force = add_force(now, kForceMax);
      takeoff_.push_back(knot);
    }
    fix_state(takeoff_.front(), task_.start);
    const PaperTakeoffLaw law{robot_, kTakeoffStep};
    for (std::size_t k = 0; k + 1 < takeoff_.size(); ++k) {
      const Knot& from = takeoff_[k];
      const Knot& to = takeoff_[k + 1];
      program_.add(law, joined(from.y, from.v, to.v, from.force));
      add_joint_euler(from, to, takeoff_step_);
      add_joint_limits(to);
    }
  }

  void add_flight() {
    const double step = guess_.duration(core::JumpPhase::flight) / kFlightSteps;
    flight_step_ = program_.add_variable(step, kFlightStep, 0.01);
    for (int k = 0; k <= kFlightSteps; ++k) {
      const PlanarInstant now =
          guess_.at(core::JumpPhase::flight, static_cast<double>(k) / kFlightSteps);
      Knot knot;
      knot.y = k == 0 ? takeoff_.back().y : add_posture(now.links);
      knot.v = add_rates(now.links);
      if (k == 0) knot.v[kTrunkPitch] = takeoff_.back().v[kTrunkPitch];
      add_trunk(now, knot);
      if (k < kFlightSteps) knot.force = add_force(now, kVirtualForceMax);
      flight_.push_back(knot);
    }
    const model::PlanarChain& chain = model_.dynamics.chain();
    const Knot& first = flight_.front();
    const model::PlanarVector<double> ankle{model_.ankle_x(), chain.sole_height};
    program_.add(TrunkPlaceLaw{chain, ankle}, joined(first.y, first.place));
    program_.add(TrunkVelocityLaw{chain}, joined(first.y, takeoff_.back().v, first.velocity));
    for (std::size_t k = 0; k + 1 < flight_.size(); ++k) add_flight_step(k);
  }
  void add_flight_step(std::size_t k) {
    const Knot& from = flight_[k];
    const Knot& to = flight_[k + 1];
    const std::array<int, 1> trunk_rate{to.v[kTrunkPitch]};
    const std::array<int, 2> force{from.force[0], from.force[1]};
    program_.add(PaperFlightLaw{robot_},
                 joined(from.y, from.v, from.velocity, to.velocity, trunk_rate, force,
                        std::array<int, 1>{flight_step_}));
    add_joint_euler(from, to, flight_step_);
    add_trunk_euler(from, to, flight_step_);
    add_joint_limits(to);
    if (k + 2 == flight_.size()) return;
    const double share = static_cast<double>(k + 1) / kFlightSteps;
    program_.add(
        PaperTerrainLaw{model_.dynamics, task_.terrain, clearance_profile(task_.clearance, share)},
        joined(to.y, to.place));
  }

  void add_landing() {
    const double step = guess_.duration(core::JumpPhase::landing) / kLandingSteps;
    landing_step_ = program_.add_variable(step, kLandingStep, 0.01);
    const model::PlanarChain& chain = model_.dynamics.chain();
    const model::PlanarVector<double> ankle{task_.distance + model_.ankle_x(),
                                            task_.height + chain.sole_height};
    for (int k = 0; k <= kLandingSteps; ++k) {
      const PlanarInstant now =
          guess_.at(core::JumpPhase::landing, static_cast<double>(k) / kLandingSteps);
      Knot knot = flight_.back();
      knot.v = add_rates(now.links);
      if (k == 0) {
        knot.v[kTrunkPitch] = flight_.back().v[kTrunkPitch];
      } else {
        knot.y = add_posture(now.links);
        add_trunk(now, knot);
        add_joint_limits(knot);
      }
      if (k < kLandingSteps) knot.force = add_force(now, kForceMax);
      program_.add(TrunkPlaceLaw{chain, ankle}, joined(knot.y, knot.place));
      program_.add(TrunkVelocityLaw{chain}, joined(knot.y, knot.v, knot.velocity));
      landing_.push_back(knot);
    }
    fix_state(landing_.back(), {task_.final_posture, {}});
    add_landing_steps();
  }
  void add_landing_steps() {
    model::LinkArray<double> as_one{};
    as_one.fill(1.0);
    const double inertia = model_.dynamics.centroidal_momentum(task_.final_posture, as_one);
    const PaperLandingLaw law{robot_, inertia};
    for (std::size_t k = 0; k + 1 < landing_.size(); ++k) {
      const Knot& from = landing_[k];
      const Knot& to = landing_[k + 1];
      program_.add(law, joined(from.y, from.v, from.velocity, to.velocity,
                               std::array<int, 1>{to.v[kTrunkPitch]}, from.force,
                               std::array<int, 1>{landing_step_}));
      // Trunk by Euler; the legs follow it by kinematics.
      add_trunk_euler(from, to, landing_step_);
      program_.add(EulerLaw{}, std::array<int, 4>{from.y[kTrunkPitch], from.v[kTrunkPitch],
                                                  to.y[kTrunkPitch], landing_step_});
    }
  }

  [[nodiscard]] PlanarMotion read(const Eigen::VectorXd& x) const {
    PlanarMotion motion;
    const auto append = [&](core::JumpPhase phase, const Knot& knot, double dt) {
      PlanarKnot out;
      out.phase = phase;
      out.dt = dt;
      out.links = links_at(knot, x);
      motion.knots.push_back(out);
    };
    for (int k = 0; k < kTakeoffSteps; ++k) {
      append(core::JumpPhase::takeoff, takeoff_[static_cast<std::size_t>(k)], kTakeoffStep);
    }
    for (int k = 0; k < kFlightSteps; ++k) {
      append(core::JumpPhase::flight, flight_[static_cast<std::size_t>(k)], x(flight_step_));
    }
    for (int k = 0; k < kLandingSteps; ++k) {
      append(core::JumpPhase::landing, landing_[static_cast<std::size_t>(k)], x(landing_step_));
    }
    append(core::JumpPhase::landing, landing_.back(), 0.0);
    complete_motion(model_, task_, motion);
    end_phase(takeoff_.back(), x, motion.knots[kTakeoffSteps - 1]);
    end_phase(flight_.back(), x, motion.knots[kTakeoffSteps + kFlightSteps - 1]);
    const LinkState liftoff = links_at(takeoff_.back(), x);
    motion.liftoff_velocity = model_.dynamics.com_velocity(liftoff.pitch, liftoff.rate);
    motion.momentum = model_.dynamics.centroidal_momentum(liftoff.pitch, liftoff.rate);
    for (std::size_t i = 0; i + 1 < motion.knots.size(); ++i) promise(i, x, motion);
    return motion;
  }

  [[nodiscard]] static LinkState links_at(const Knot& knot, const Eigen::VectorXd& x) {
    return {links_from_coordinates(x(knot.y[0]), x(knot.y[1]), x(knot.y[2]), 0.0),
            links_from_coordinates(x(knot.v[0]), x(knot.v[1]), x(knot.v[2]), 0.0)};
  }
  /// The legs' rates jump from phase to phase: the last step leads to those before the jump.
  static void end_phase(const Knot& end, const Eigen::VectorXd& x, PlanarKnot& last) {
    const LinkState links = links_at(end, x);
    for (std::size_t j = 0; j < model::kPlanarLinks; ++j) {
      last.acceleration[j] = (links.rate[j] - last.links.rate[j]) / last.dt;
    }
  }

  /// Forces, torques and the ankle's place as this formulation has them.
  void promise(std::size_t i, const Eigen::VectorXd& x, PlanarMotion& motion) const {
    PlanarKnot& knot = motion.knots[i];
    const model::PlanarChain& chain = model_.dynamics.chain();
    const LinkState& links = knot.links;
    PromisedStep promised;
    if (knot.phase == core::JumpPhase::flight) {
      const Knot& at = flight_[i - kTakeoffSteps];
      const model::PlanarVector<double> r = trunk_com(chain, links.pitch);
      const model::PlanarVector<double> v = trunk_com_velocity(chain, links.pitch, links.rate);
      promised.ankle = {x(at.place[0]) - r.x, x(at.place[1]) - r.z};
      promised.ankle_velocity = {x(at.velocity[0]) - v.x, x(at.velocity[1]) - v.z};
      const model::PlanarVector<double> force{x(at.force[0]), x(at.force[1])};
      promised.tau = static_torques(chain, links.pitch, force, 0.0);
    } else {
      const bool takeoff = knot.phase == core::JumpPhase::takeoff;
      const Knot& at = takeoff ? takeoff_[i] : landing_[i - kTakeoffSteps - kFlightSteps];
      promised.ankle = takeoff ? motion.start_ankle : motion.target_ankle;
      promised.force = {x(at.force[0]), x(at.force[1])};
      promised.moment = x(at.force[2]);
      promised.tau = static_torques(chain, links.pitch, promised.force, promised.moment);
    }
    knot.promised = promised;
  }

  const PlanarModel& model_;
  const PlanarTask& task_;
  MotionSampler guess_;
  PaperRobot robot_;
  ProgramBuilder program_;
  std::vector<Knot> takeoff_;
  std::vector<Knot> flight_;
  std::vector<Knot> landing_;
  int takeoff_step_ = 0;
  int flight_step_ = 0;
  int landing_step_ = 0;
};

}  // namespace

FormulatedJump solve_paper(const PlanarModel& model, const PlanarTask& task,
                           const SolveOptions& options) {
  return PaperProgram(model, task).solve(options);
}

}  // namespace hopscotch::planner
