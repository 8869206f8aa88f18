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

/// Accelerations enter `forces` by this matrix: inertia forces of the links, summed up from the
/// trunk down as the joints feel them, and rotors. Written out, since this is most of the time of a
/// certificate.
template <int N>
Eigen::Matrix<double, N, N> inertia_of(const model::PlanarDynamics& dynamics,
                                       const LinkArray<double>& a) {
  constexpr std::size_t kFirst = model::kPlanarLinks - static_cast<std::size_t>(N);
  const model::PlanarDynamics::Coupling& coupling = N == 3 ? dynamics.pinned() : dynamics.free();
  Eigen::Matrix<double, N, N> link;  // rows and columns by link
  for (std::size_t j = kFirst; j < model::kPlanarLinks; ++j) {
    const auto row = static_cast<Eigen::Index>(j - kFirst);
    link(row, row) = coupling.real[j][j];
    for (std::size_t k = j + 1; k < model::kPlanarLinks; ++k) {
      const auto column = static_cast<Eigen::Index>(k - kFirst);
      const double angle = a[j] - a[k];
      link(row, column) = link(column, row) =
          coupling.real[j][k] * std::cos(angle) - coupling.imaginary[j][k] * std::sin(angle);
    }
  }
  constexpr auto kColumn = [](std::size_t of) { return static_cast<Eigen::Index>(of - kFirst); };
  constexpr Eigen::Index kTrunkAt = kColumn(model::kTrunk);
  constexpr Eigen::Index kThighAt = kColumn(model::kThigh);
  constexpr Eigen::Index kShankAt = kColumn(model::kShank);
  const model::PlanarChain& chain = dynamics.chain();
  Eigen::Matrix<double, N, N> joint;  // rows: hip, knee, ankle and, in flight, momentum
  joint.row(0) = -link.row(kTrunkAt);
  joint.row(1) = joint.row(0) - link.row(kThighAt);
  joint.row(2) = joint.row(1) - link.row(kShankAt);
  if constexpr (N == 4) joint.row(3) = link.colwise().sum();
  joint(0, kThighAt) += chain.armature_hip;
  joint(0, kTrunkAt) -= chain.armature_hip;
  joint(1, kShankAt) += chain.armature_knee;
  joint(1, kThighAt) -= chain.armature_knee + chain.armature_ankle;
  joint(2, kThighAt) -= chain.armature_ankle;
  if constexpr (N == 4) {
    joint(1, kColumn(model::kFoot)) += chain.armature_ankle;
    joint(2, kColumn(model::kFoot)) += chain.armature_ankle;
  }
  return joint;
}

template <int N>
LinkArray<double> solve(const model::PlanarDynamics& dynamics, const LinkState& links,
                        const Eigen::Vector<double, N>& wanted) {
  constexpr std::size_t kFirst = model::kPlanarLinks - static_cast<std::size_t>(N);
  const Eigen::Vector<double, N> bias = forces<N>(dynamics, links, LinkArray<double>{});
  const Eigen::Matrix<double, N, N> inverse = inertia_of<N>(dynamics, links.pitch).inverse();
  const Eigen::Vector<double, N> found = inverse * (wanted - bias);
  LinkArray<double> acceleration{};
  for (int j = 0; j < N; ++j) acceleration[kFirst + static_cast<std::size_t>(j)] = found(j);
  return acceleration;
}

}  // namespace

LinkState advanced(const LinkState& from, const LinkArray<double>& rate,
                   const LinkArray<double>& acceleration, double h) {
  LinkState to = from;
  for (std::size_t j = 0; j < model::kPlanarLinks; ++j) {
    to.pitch[j] += h * rate[j];
    to.rate[j] += h * acceleration[j];
  }
  return to;
}

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
