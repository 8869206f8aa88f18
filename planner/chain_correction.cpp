#include "planner/chain_correction.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "planner/forward_dynamics.hpp"
#include "planner/shared_limits.hpp"

namespace hopscotch::planner {

namespace {

using model::LinkArray;

/// Kept from a physical limit, in row units: what lies between the places that are looked at, and a
/// light foot, whose friction is a small number of newtons.
constexpr double kMargin = 5e-3;
constexpr double kTerrainScale = 0.1;       // of clearances among defects [m]
constexpr double kSoleMargin = 1e-3;        // kept from the terrain [m]
constexpr double kShankMargin = 2.5e-3;     // the same; it swings past edges between two looks [m]
constexpr double kContactAllowance = 2e-3;  // sole and terrain touch [m]
/// Of the clearance that knots ask of the feet, kept between them: a toe rises past a riser in less
/// than a step.
constexpr double kFootShare = 0.5;
/// Longest step of the integration; its error is far below what is looked for [s].
constexpr double kStepMax = 4e-3;
constexpr double kRateScale = 21.0;  // of the errors of rates [rad/s]

/// Of the clearance rows.
constexpr bool is_foot(std::size_t row) {
  return row < ClearanceLaw::kFootRows;
}

/// By how much each row of a step exceeds its physical limits at most, on either side; less than
/// zero where there is room.
struct Excess {
  std::array<double, ChainLayout::kStanceRows> below;
  std::array<double, ChainLayout::kStanceRows> above;
  std::array<double, ClearanceLaw::kRowCount> terrain;  ///< [m]

  Excess() {
    below.fill(-kUnbounded);
    above.fill(-kUnbounded);
    terrain.fill(-kUnbounded);
  }
};

/// The physical limits of a step, at any instant of it.
class StepLimits {
 public:
  StepLimits(const PlanarModel& model, const PlanarTask& task, const PlanarMotion& motion)
      : model_(model), task_(task), motion_(motion) {
    motors_.limits = motor_limits(model.robot, Reserves{1.0, 1.0, 1.0, 1.0});
    ground_ = ground_rows(model.dynamics.chain(), model.config, 0.0);
    ground_.friction = kFrictionShareMax * model.config.friction;
    ground_.normal_force_min = 0.0;
    motors_.bounds(std::span(lower_).first<MotorRows::kRows>(),
                   std::span(upper_).first<MotorRows::kRows>());
    ground_.bounds(std::span(lower_).subspan<MotorRows::kRows>(),
                   std::span(upper_).subspan<MotorRows::kRows>());
  }

  /// @param now An instant of the step as a knot.
  void note(const PlanarKnot& now, const model::PlanarJoints<double>& tau, Excess& excess) const {
    const LinkState& links = now.links;
    std::array<double, ChainLayout::kStanceRows> row{};
    motors_.write(tau, links.rate, LinkArray<double>{}, row.data());
    std::size_t rows = MotorRows::kRows;
    if (now.phase == core::JumpPhase::flight) {
      note_terrain(now.time, links.pitch, excess);
    } else {
      ground_.write(model_.dynamics.stance_loads(links.pitch, links.rate, now.acceleration),
                    row.data() + MotorRows::kRows);
      rows = row.size();
    }
    for (std::size_t r = 0; r < rows; ++r) {
      excess.below[r] = std::max(excess.below[r], lower_[r] - row[r]);
      excess.above[r] = std::max(excess.above[r], row[r] - upper_[r]);
    }
  }

 private:
  void note_terrain(double time, const LinkArray<double>& a, Excess& excess) const {
    const double t = time - motion_.liftoff_time;
    const model::PlanarVector<double> com = model_.dynamics.com(a);
    const model::PlanarVector<double>& v = motion_.liftoff_velocity;
    const model::PlanarVector<double> ankle{
        motion_.liftoff_com.x + v.x * t - com.x,
        motion_.liftoff_com.z + v.z * t - 0.5 * model::kGravity * t * t - com.z};
    const double share = t / (motion_.touchdown_time - motion_.liftoff_time);
    const double foot = kFootShare * clearance_profile(task_.clearance, share) - kContactAllowance;
    const double shank = model_.robot.shank_radius + ClearanceLaw::kShankAllowance;
    const auto points = ClearanceLaw::points(model_.dynamics, a);
    for (std::size_t r = 0; r < points.size(); ++r) {
      const double depth =
          task_.terrain.at(ankle.x + points[r].x - ClearanceLaw::look_back(r)).height - ankle.z -
          points[r].z;
      excess.terrain[r] = std::max(excess.terrain[r], depth + (is_foot(r) ? foot : shank));
    }
  }

  const PlanarModel& model_;
  const PlanarTask& task_;
  const PlanarMotion& motion_;
  MotorRows motors_;
  GroundRows ground_;
  std::array<double, ChainLayout::kStanceRows> lower_{};
  std::array<double, ChainLayout::kStanceRows> upper_{};
};

LinkArray<double> mean(const LinkArray<double>& a, const LinkArray<double>& b,
                       const LinkArray<double>& c, const LinkArray<double>& d) {
  LinkArray<double> out;
  for (std::size_t j = 0; j < out.size(); ++j) {
    out[j] = (a[j] + 2.0 * (b[j] + c[j]) + d[j]) / 6.0;
  }
  return out;
}

/// Where a step ends when its torques are held (Runge-Kutta of fourth order); notes the limits on
/// the way.
LinkState integrate_step(const PlanarModel& model, const PlanarKnot& knot,
                         const model::PlanarJoints<double>& tau, const StepLimits& limits,
                         Excess& excess) {
  const auto acceleration = [&](const LinkState& links) {
    return knot.phase == core::JumpPhase::flight ? flight_acceleration(model.dynamics, links, tau)
                                                 : stance_acceleration(model.dynamics, links, tau);
  };
  const int substeps = static_cast<int>(std::ceil(knot.dt / kStepMax));
  const double h = knot.dt / substeps;
  PlanarKnot now = knot;
  LinkState& state = now.links;
  for (int i = 0; i < substeps; ++i) {
    const LinkArray<double> a0 = now.acceleration = acceleration(state);
    limits.note(now, tau, excess);
    const LinkState first = advanced(state, state.rate, a0, 0.5 * h);
    const LinkArray<double> a1 = acceleration(first);
    const LinkState second = advanced(state, first.rate, a1, 0.5 * h);
    const LinkArray<double> a2 = acceleration(second);
    const LinkState third = advanced(state, second.rate, a2, h);
    const LinkArray<double> a3 = acceleration(third);
    state = advanced(state, mean(state.rate, first.rate, second.rate, third.rate),
                     mean(a0, a1, a2, a3), h);
    now.time += h;
  }
  now.acceleration = acceleration(state);
  limits.note(now, tau, excess);
  return state;
}

/// Adds what the end of the step misses. @return its size.
double correct_step(const PlanarKnot& knot, const PlanarKnot& next, const LinkState& reached,
                    StepCorrection& correction) {
  double defect = 0.0;
  for (std::size_t j = 0; j < model::kPlanarLinks; ++j) {
    const double turn = reached.pitch[j] - next.links.pitch[j];
    const double rate = reached.rate[j] - (knot.links.rate[j] + knot.dt * knot.acceleration[j]);
    correction.turn[j] += turn;
    correction.acceleration[j] -= rate / knot.dt;
    defect = std::max({defect, std::abs(turn), std::abs(rate) / kRateScale});
  }
  return defect;
}

/// First row of step `i` of the whole jump.
int first_row(const ChainLayout& layout, int i) {
  const StepCounts& steps = layout.steps();
  if (i < steps.takeoff) return layout.takeoff_rows(i);
  if (i < steps.takeoff + steps.flight) return layout.flight_rows(i - steps.takeoff);
  return layout.landing_rows(i - steps.takeoff - steps.flight);
}

/// Bounds for the rows of a step that take back what exceeds the limits between its ends: a row at
/// the mid-point and the worst instant are taken to change alike.
double bound_rows(const Excess& excess, int first, int rows, const Eigen::VectorXd& values,
                  ChainCorrection& correction) {
  double worst = 0.0;
  for (int r = 0; r < rows; ++r) {
    const double below = excess.below[static_cast<std::size_t>(r)];
    const double above = excess.above[static_cast<std::size_t>(r)];
    correction.lower(first + r) = values(first + r) + below + kMargin;
    correction.upper(first + r) = values(first + r) - above - kMargin;
    worst = std::max({worst, below, above});
  }
  return worst;
}

/// The same for the clearances of the knots at the ends of flight step `k`.
double bound_clearance(const Excess& excess, const ChainLayout& layout, int k,
                       const Eigen::VectorXd& values, ChainCorrection& correction) {
  double worst = 0.0;
  for (std::size_t r = 0; r < excess.terrain.size(); ++r) {
    const double missing = excess.terrain[r];
    worst = std::max(worst, missing / kTerrainScale);
    for (const int step : {k - 1, k}) {
      if (step < 0 || step + 1 >= layout.steps().flight) continue;
      const int row = layout.clearance(step) + static_cast<int>(r);
      correction.lower(row) = std::max(
          correction.lower(row), values(row) + missing + (is_foot(r) ? kSoleMargin : kShankMargin));
    }
  }
  return worst;
}

}  // namespace

ChainCorrection::ChainCorrection(const ChainLayout& layout)
    : steps(static_cast<std::size_t>(layout.steps().takeoff + layout.steps().flight +
                                     layout.steps().landing)),
      lower(layout.row_slots()),
      upper(layout.row_slots()) {
  clear_bounds();
}

void ChainCorrection::clear() {
  std::fill(steps.begin(), steps.end(), StepCorrection{});
  clear_bounds();
}

void ChainCorrection::clear_bounds() {
  lower.setConstant(-kUnbounded);
  upper.setConstant(kUnbounded);
}

MotionDefect update_correction(const PlanarModel& model, const PlanarTask& task,
                               const ChainLayout& layout, const SolvedRows& solved,
                               ChainCorrection& correction) {
  const PlanarMotion& motion = solved.motion;
  const StepLimits limits(model, task, motion);
  MotionDefect defect;
  correction.clear_bounds();
  for (std::size_t i = 0; i < correction.steps.size(); ++i) {
    const PlanarKnot& knot = motion.knots[i];
    const model::PlanarJoints<double> tau = instant(model, motion, knot, 0.5 * knot.dt).tau;
    Excess excess;
    const LinkState reached = integrate_step(model, knot, tau, limits, excess);
    defect.dynamics = std::max(
        defect.dynamics, correct_step(knot, motion.knots[i + 1], reached, correction.steps[i]));
    const int step = static_cast<int>(i);
    const bool flight = knot.phase == core::JumpPhase::flight;
    const int rows = flight ? ChainLayout::kFlightRows : ChainLayout::kStanceRows;
    defect.limits = std::max(defect.limits, bound_rows(excess, first_row(layout, step), rows,
                                                       solved.values, correction));
    if (!flight) continue;
    defect.limits = std::max(
        defect.limits,
        bound_clearance(excess, layout, step - layout.steps().takeoff, solved.values, correction));
  }
  return defect;
}

void set_correction(const ChainCorrection& correction, PlanarMotion& motion) {
  for (std::size_t i = 0; i < correction.steps.size(); ++i) {
    motion.knots[i].correction = correction.steps[i];
  }
}

}  // namespace hopscotch::planner
