#include "planner/forward_dynamics.hpp"

#include <Eigen/Dense>
#include <cmath>

namespace hopscotch::planner {

namespace {

using model::LinkArray;
using model::PlanarJoints;

constexpr double kStep = 1e-3;  // [s]

/// Inverse dynamics as one vector: three joint torques and, in flight, the momentum rate.
template <int N>
Eigen::Vector<double, N> forces(const model::PlanarDynamics& dynamics, const LinkState& links,
                                const LinkArray<double>& acceleration) {
  if constexpr (N == 3) {
    const PlanarJoints<double> tau =
        dynamics.stance_loads(links.pitch, links.rate, acceleration).tau;
    return {tau.hip, tau.knee, tau.ankle};
  } else {
    const PlanarJoints<double> tau = dynamics.flight_torques(links.pitch, links.rate, acceleration);
    return {tau.hip, tau.knee, tau.ankle,
            dynamics.momentum_rate(links.pitch, links.rate, acceleration)};
  }
}

template <int N>
LinkArray<double> solve(const model::PlanarDynamics& dynamics, const LinkState& links,
                        const Eigen::Vector<double, N>& wanted) {
  constexpr std::size_t kFirst = model::kPlanarLinks - static_cast<std::size_t>(N);
  const Eigen::Vector<double, N> bias = forces<N>(dynamics, links, LinkArray<double>{});
  Eigen::Matrix<double, N, N> inertia;
  for (int j = 0; j < N; ++j) {
    LinkArray<double> unit{};
    unit[kFirst + static_cast<std::size_t>(j)] = 1.0;
    inertia.col(j) = forces<N>(dynamics, links, unit) - bias;
  }
  const Eigen::Vector<double, N> found = inertia.partialPivLu().solve(wanted - bias);
  LinkArray<double> acceleration{};
  for (int j = 0; j < N; ++j) acceleration[kFirst + static_cast<std::size_t>(j)] = found(j);
  return acceleration;
}

LinkState advanced(const LinkState& from, const LinkArray<double>& rate,
                   const LinkArray<double>& acceleration, double h) {
  LinkState to = from;
  for (std::size_t j = 0; j < model::kPlanarLinks; ++j) {
    to.pitch[j] += h * rate[j];
    to.rate[j] += h * acceleration[j];
  }
  return to;
}

}  // namespace

LinkArray<double> stance_acceleration(const model::PlanarDynamics& dynamics, const LinkState& links,
                                      const PlanarJoints<double>& tau) {
  return solve<3>(dynamics, links, {tau.hip, tau.knee, tau.ankle});
}

LinkArray<double> flight_acceleration(const model::PlanarDynamics& dynamics, const LinkState& links,
                                      const PlanarJoints<double>& tau) {
  return solve<4>(dynamics, links, {tau.hip, tau.knee, tau.ankle, 0.0});
}

LinkState integrate(const model::PlanarDynamics& dynamics, core::JumpPhase phase,
                    const LinkState& from, const PlanarJoints<double>& tau, double duration) {
  const int steps = static_cast<int>(std::ceil(duration / kStep));
  const double h = duration / steps;
  LinkState state = from;
  const auto acceleration = [&](const LinkState& links) {
    return phase == core::JumpPhase::flight ? flight_acceleration(dynamics, links, tau)
                                            : stance_acceleration(dynamics, links, tau);
  };
  for (int i = 0; i < steps; ++i) {  // mid-point rule: its error is far below what is looked for
    const LinkState middle = advanced(state, state.rate, acceleration(state), 0.5 * h);
    state = advanced(state, middle.rate, acceleration(middle), h);
  }
  return state;
}

}  // namespace hopscotch::planner
