#include "planner/chain_correction.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "planner/forward_dynamics.hpp"
#include "planner/shared_limits.hpp"

namespace hopscotch::planner {

namespace {

using model::LinkArray;

/// Kept from a physical limit that was broken, in row units: what lies between the places that are
/// looked at, and a light foot, whose friction is a small number of newtons.
constexpr double kMargin = 1e-2;
/// Longest step of the integration; its error is far below what is looked for [s].
constexpr double kStepMax = 4e-3;
constexpr double kRateScale = 21.0;  // of the errors of rates [rad/s]

/// The rows of a step against the physical limits.
class StepRows {
 public:
  using Excess = std::array<double, ChainLayout::kStanceRows>;

  explicit StepRows(const PlanarModel& model) : dynamics_(model.dynamics) {
    motors_.limits = motor_limits(model.robot, Reserves{1.0, 1.0, 1.0, 1.0});
    ground_ = ground_rows(model.dynamics.chain(), model.config, 0.0);
    ground_.friction = model.config.friction;
    ground_.normal_force_min = 0.0;
    motors_.bounds(std::span(lower_).first<MotorRows::kRows>(),
                   std::span(upper_).first<MotorRows::kRows>());
    ground_.bounds(std::span(lower_).subspan<MotorRows::kRows>(),
                   std::span(upper_).subspan<MotorRows::kRows>());
  }

  /// Raises `worst` to by how much each row exceeds its limits at this instant.
  void note(core::JumpPhase phase, const LinkState& links, const LinkArray<double>& acceleration,
            const model::PlanarJoints<double>& tau, Excess& worst) const {
    Excess row{};
    motors_.write(tau, links.rate, LinkArray<double>{}, row.data());
    std::size_t rows = MotorRows::kRows;
    if (phase != core::JumpPhase::flight) {
      ground_.write(dynamics_.stance_loads(links.pitch, links.rate, acceleration),
                    row.data() + MotorRows::kRows);
      rows = row.size();
    }
    for (std::size_t r = 0; r < rows; ++r) {
      worst[r] = std::max({worst[r], row[r] - upper_[r] + kMargin, lower_[r] - row[r] + kMargin});
    }
  }

 private:
  const model::PlanarDynamics& dynamics_;
  MotorRows motors_;
  GroundRows ground_;
  Excess lower_{};
  Excess upper_{};
};

LinkArray<double> mean(const LinkArray<double>& a, const LinkArray<double>& b,
                       const LinkArray<double>& c, const LinkArray<double>& d) {
  LinkArray<double> out;
  for (std::size_t j = 0; j < out.size(); ++j) {
    out[j] = (a[j] + 2.0 * (b[j] + c[j]) + d[j]) / 6.0;
  }
  return out;
}

/// Where a step ends when its torques are held (Runge-Kutta of fourth order); notes the rows on the
/// way.
LinkState integrate_step(const PlanarModel& model, const PlanarKnot& knot,
                         const model::PlanarJoints<double>& tau, const StepRows& limits,
                         StepRows::Excess& worst) {
  const auto acceleration = [&](const LinkState& links) {
    return knot.phase == core::JumpPhase::flight ? flight_acceleration(model.dynamics, links, tau)
                                                 : stance_acceleration(model.dynamics, links, tau);
  };
  const int substeps = static_cast<int>(std::ceil(knot.dt / kStepMax));
  const double h = knot.dt / substeps;
  LinkState state = knot.links;
  for (int i = 0; i < substeps; ++i) {
    const LinkArray<double> a0 = acceleration(state);
    limits.note(knot.phase, state, a0, tau, worst);
    const LinkState first = advanced(state, state.rate, a0, 0.5 * h);
    const LinkArray<double> a1 = acceleration(first);
    const LinkState second = advanced(state, first.rate, a1, 0.5 * h);
    const LinkArray<double> a2 = acceleration(second);
    const LinkState third = advanced(state, second.rate, a2, h);
    const LinkArray<double> a3 = acceleration(third);
    state = advanced(state, mean(state.rate, first.rate, second.rate, third.rate),
                     mean(a0, a1, a2, a3), h);
  }
  limits.note(knot.phase, state, acceleration(state), tau, worst);
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

}  // namespace

ChainCorrection::ChainCorrection(const ChainLayout& layout)
    : steps(static_cast<std::size_t>(layout.steps().takeoff + layout.steps().flight +
                                     layout.steps().landing)),
      tightening(Eigen::VectorXd::Zero(layout.row_slots())) {}

MotionDefect add_correction(const PlanarModel& model, const PlanarMotion& motion,
                            const ChainLayout& layout, ChainCorrection& correction) {
  const StepRows limits(model);
  const StepCounts& steps = layout.steps();
  MotionDefect defect;
  for (std::size_t i = 0; i < correction.steps.size(); ++i) {
    const PlanarKnot& knot = motion.knots[i];
    const int k = static_cast<int>(i);
    int first = layout.takeoff_rows(k);
    if (k >= steps.takeoff) first = layout.flight_rows(k - steps.takeoff);
    if (k >= steps.takeoff + steps.flight) {
      first = layout.landing_rows(k - steps.takeoff - steps.flight);
    }
    const model::PlanarJoints<double> tau = instant(model, motion, knot, 0.5 * knot.dt).tau;
    StepRows::Excess excess{};
    const LinkState reached = integrate_step(model, knot, tau, limits, excess);
    defect.dynamics = std::max(
        defect.dynamics, correct_step(knot, motion.knots[i + 1], reached, correction.steps[i]));
    const bool flight = knot.phase == core::JumpPhase::flight;
    const int rows = flight ? ChainLayout::kFlightRows : ChainLayout::kStanceRows;
    for (int r = 0; r < rows; ++r) {
      const double missing = excess[static_cast<std::size_t>(r)];
      correction.tightening(first + r) += missing;
      defect.limits = std::max(defect.limits, missing - kMargin);
    }
  }
  return defect;
}

void set_correction(const ChainCorrection& correction, PlanarMotion& motion) {
  for (std::size_t i = 0; i < correction.steps.size(); ++i) {
    motion.knots[i].correction = correction.steps[i];
  }
}

}  // namespace hopscotch::planner
