#include "planner/formulation.hpp"
#include "planner/landing_phase.hpp"
#include "planner/program_builder.hpp"
#include "planner/warm_start.hpp"

namespace hopscotch::planner {

namespace {

// As many steps as the source's comparison has, and as short.
constexpr StepCounts kSteps{70, 30, 30};
constexpr double kTakeoffStep = 0.01;  // [s]

constexpr int kFloatingDof = 6;        // shank, knee, trunk, foot, and the ankle's x and z
constexpr double kSpeedMax = 10.0;     // of the ankle [m/s]
constexpr double kTypicalSpeed = 2.0;  // [m/s]

/// One step of the floating-base chain in the air: H q'' + C = Gamma without any ground force, as
/// the motion of the CoM, the angular momentum and the joint torques, which are limited.
struct FloatingLaw {
  static constexpr int kRows = 3 + FlightLaw::kRows;
  FlightLaw joints;

  template <typename T>
  T operator()(const std::array<T, 19>& x, std::array<T, kRows>& rows) const {
    const model::LinkArray<T> a = links_from_coordinates(x[0], x[1], x[2], x[3]);
    const model::LinkArray<T> w = links_from_coordinates(x[6], x[7], x[8], x[9]);
    const model::LinkArray<T> u = links_from_coordinates(x[12], x[13], x[14], x[15]);
    model::PlanarVector<T> com{x[16], x[17]};
    for (std::size_t j = 0; j < model::kPlanarLinks; ++j) {
      const model::PlanarVector<double> share = joints.dynamics.com_share(j);
      const model::PlanarVector<T> r = model::PlanarDynamics::turned(share.x, share.z, a[j]);
      const T square = w[j] * w[j];
      com.x = com.x + u[j] * r.z - square * r.x;
      com.z = com.z - u[j] * r.x - square * r.z;
    }
    rows[0] = com.x * (1.0 / model::kGravity);
    rows[1] = com.z * (1.0 / model::kGravity) + T(1.0);
    rows[2] = joints.dynamics.momentum_rate(a, w, u);
    const model::PlanarJoints<T> tau = joints.dynamics.flight_torques(a, w, u);
    joints.motors.write(tau, w, half_change(u, x[18]), rows.data() + 3);
    return joints.objective(a, w, u, tau);
  }
  void bounds(std::span<double> lower, std::span<double> upper) const {
    std::fill_n(lower.begin(), 3, 0.0);
    std::fill_n(upper.begin(), 3, 0.0);
    joints.bounds(lower.subspan(3), upper.subspan(3));
  }
};

/// Toe, heel and shank above the terrain: shank, knee, trunk, foot, ankle x and z.
struct FloatingClearance {
  static constexpr int kRows = ClearanceLaw::kRows;
  ClearanceLaw law;

  template <typename T>
  T operator()(const std::array<T, kFloatingDof>& x, std::array<T, kRows>& rows) const {
    const model::LinkArray<T> a = links_from_coordinates(x[0], x[1], x[2], x[3]);
    const auto points = ClearanceLaw::points(law.dynamics, a);
    for (std::size_t r = 0; r < points.size(); ++r) {
      const T along = x[4] + points[r].x - ClearanceLaw::look_back(r);
      rows[r] = x[5] + points[r].z - law.terrain.height(along);
    }
    return T(0.0);
  }
  void bounds(std::span<double> lower, std::span<double> upper) const { law.bounds(lower, upper); }
};

/// The ground stops the foot and leaves the CoM's velocity and the trunk's rate. Variables: shank,
/// knee, trunk; their rates, the foot's and the ankle's velocity before; the three rates after.
struct FloatingTouchdown {
  static constexpr int kRows = 3;
  model::PlanarDynamics dynamics;
  double jump_cost = 0.0;

  template <typename T>
  T operator()(const std::array<T, 12>& x, std::array<T, kRows>& rows) const {
    const T zero = T(0.0);
    const model::LinkArray<T> a = links_from_coordinates(x[0], x[1], x[2], zero);
    const model::LinkArray<T> before = links_from_coordinates(x[3], x[4], x[5], x[6]);
    const model::LinkArray<T> after = links_from_coordinates(x[9], x[10], x[11], zero);
    const model::PlanarVector<T> moving = dynamics.com_velocity(a, before);
    const model::PlanarVector<T> pinned = dynamics.com_velocity(a, after);
    rows[0] = x[7] + moving.x - pinned.x;
    rows[1] = x[8] + moving.z - pinned.z;
    rows[2] = x[11] - x[5];
    T cost = zero;
    for (std::size_t j = 0; j < model::kPlanarLinks; ++j) {
      const T change = after[j] - before[j];
      cost = cost + jump_cost * (change * change);
    }
    return cost;
  }
  void bounds(std::span<double> lower, std::span<double> upper) const {
    std::fill_n(lower.begin(), kRows, 0.0);
    std::fill_n(upper.begin(), kRows, 0.0);
  }
};

PlannerConfig fine_config(PlannerConfig config, const PlanarTask& task) {
  const double landing = config.landing_step_longest(task.distance, task.height) *
                         config.steps.landing / kSteps.landing;
  config.steps = kSteps;
  config.takeoff_first_step = config.takeoff_last_step = kTakeoffStep;
  config.flight_step_min *= 0.5;
  config.landing_first_share = 1.0;
  config.landing_step_min = 0.5 * landing;
  config.landing_step_max = config.landing_step_hard = landing;
  return config;
}

/// The flight's knots: angles as the decision layout has them, and the ankle.
class FloatingFlight {
 public:
  FloatingFlight(const PlanarModel& model, const PlanarTask& task, const DecisionLayout& layout,
                 const PlanarMotion& guess, ProgramBuilder& program)
      : layout_(layout) {
    const int last = kSteps.flight;
    for (int k = 0; k <= last; ++k) {
      const PlanarKnot& knot = guess.knots[static_cast<std::size_t>(kSteps.takeoff + k)];
      const PlanarInstant now = instant(model, guess, knot, 0.0);
      Ankle ankle;
      ankle.place = {program.add_variable(now.ankle.x, {}), program.add_variable(now.ankle.z, {})};
      const PlannerConfig& config = model.config;
      ValueRange along{-kSpeedMax, kSpeedMax};
      ValueRange up = along;
      if (k == last) {
        along = {-config.touchdown_speed_along, config.touchdown_speed_along};
        up = {-config.touchdown_speed_down, -config.touchdown_speed_down_min};
      }
      ankle.speed = {program.add_variable(now.ankle_velocity.x, along, kTypicalSpeed),
                     program.add_variable(now.ankle_velocity.z, up, kTypicalSpeed)};
      ankles_.push_back(ankle);
    }
    fix(0, guess.start_ankle, program);
    fix(last, {task.distance + model.ankle_x(), task.height + model.dynamics.chain().sole_height},
        program);
    for (const int speed : ankles_[0].speed) program.fix(speed, 0.0);
  }

  /// Shank, knee, trunk, foot, ankle x, z.
  [[nodiscard]] std::array<int, kFloatingDof> places(int k) const {
    const std::array<int, 2>& ankle = ankles_[static_cast<std::size_t>(k)].place;
    const int y = k == 0 ? layout_.takeoff(kSteps.takeoff) : layout_.flight(k);
    return {y, y + 1, y + 2, k == 0 ? kNoVariable : y + kFootPitch, ankle[0], ankle[1]};
  }
  [[nodiscard]] std::array<int, kFloatingDof> rates(int k) const {
    const std::array<int, 2>& ankle = ankles_[static_cast<std::size_t>(k)].speed;
    const int v =
        k == 0 ? layout_.takeoff(kSteps.takeoff) + kStanceDof : layout_.flight(k) + kFlightDof;
    return {v, v + 1, v + 2, k == 0 ? kNoVariable : v + kFootPitch, ankle[0], ankle[1]};
  }

 private:
  struct Ankle {
    std::array<int, 2> place;
    std::array<int, 2> speed;
  };
  void fix(int k, const model::PlanarVector<double>& place, ProgramBuilder& program) {
    program.fix(ankles_[static_cast<std::size_t>(k)].place[0], place.x);
    program.fix(ankles_[static_cast<std::size_t>(k)].place[1], place.z);
  }

  const DecisionLayout& layout_;
  std::vector<Ankle> ankles_;
};

void add_floating_flight(const PlanarModel& model, const PlanarTask& task,
                         const DecisionLayout& layout, const FloatingFlight& flight,
                         ProgramBuilder& program) {
  using Step = StepBlock<FloatingLaw, kFloatingDof, StepLength::free>;
  const FloatingLaw law{flight_law(model, task)};
  const JointRows<kFlightDof> joints = joint_rows<kFlightDof>(model.robot, model.config);
  program.add(liftoff_law(model), liftoff_variables(layout));
  for (int k = 0; k < kSteps.flight; ++k) {
    const std::array<int, 1> length{layout.flight_step()};
    program.add(std::make_unique<Step>(law,
                                       joined(flight.places(k), flight.rates(k),
                                              flight.places(k + 1), flight.rates(k + 1), length),
                                       1.0));
    program.add(joints, consecutive<8>(layout.flight(k + 1)));
    if (k + 1 == kSteps.flight) break;
    program.add(FloatingClearance{clearance_law(model, task, k + 1)}, flight.places(k + 1));
  }
}

void add_fine_landing(const PlanarModel& model, const PlanarTask& task,
                      const DecisionLayout& layout, const FloatingFlight& flight,
                      ProgramBuilder& program) {
  using Step = StepBlock<StanceLaw, kStanceDof, StepLength::free>;
  const std::array<int, kFloatingDof> place = flight.places(kSteps.flight);
  const std::array<int, 3> posture{place[0], place[1], place[2]};
  program.add(
      FloatingTouchdown{model.dynamics, model.config.rate_jump_cost},
      joined(posture, flight.rates(kSteps.flight), consecutive<3>(layout.touchdown_rates())));
  const JointRows<kStanceDof> joints = joint_rows<kStanceDof>(model.robot, model.config);
  for (int k = 0; k < kSteps.landing; ++k) {
    const std::array<int, 13> ends = layout.landing_step_variables(k);
    program.add(
        std::make_unique<Step>(landing_law(model, task, k), ends, model.config.landing_share(k)));
    std::array<int, 6> before{};
    std::copy_n(ends.begin(), before.size(), before.begin());
    program.add(joints, before);
  }
}

}  // namespace

FormulatedJump solve_full(const PlanarModel& coarse, const PlanarTask& task,
                          const SolveOptions& options) {
  const PlanarModel model(coarse.robot, fine_config(coarse.config, task));
  const DecisionLayout layout(kSteps);
  const Eigen::VectorXd guess = kinematic_guess(model, task, layout);
  const DecisionBounds bounds = decision_bounds(model, task, layout);
  const Eigen::VectorXd sizes = decision_sizes(layout);
  ProgramBuilder program;
  for (int i = 0; i < layout.size(); ++i) {
    (void)program.add_variable(guess(i), {bounds.lower(i), bounds.upper(i)}, sizes(i));
  }
  const FloatingFlight flight(model, task, layout, motion_from_decision(model, task, layout, guess),
                              program);
  BlockList takeoff;
  add_takeoff(model, task, layout, takeoff);
  for (auto& block : takeoff) program.add(std::move(block));
  add_floating_flight(model, task, layout, flight, program);
  add_fine_landing(model, task, layout, flight, program);
  FormulatedJump jump;
  jump.variables = program.variables();
  jump.outcome = program.solve(options, jump.rows);
  jump.motion = motion_from_decision(model, task, layout, jump.outcome.x);
  return jump;
}

}  // namespace hopscotch::planner
