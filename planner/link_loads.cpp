#include "planner/link_loads.hpp"

#include <cmath>
#include <utility>

namespace hopscotch::planner {

namespace {

using model::kFoot;
using model::kPlanarLinks;
using model::kShank;
using Coupling = model::PlanarDynamics::Coupling;

/// H_jk and its negative derivative by the angle between the links.
struct PairTerms {
  std::size_t j = 0;
  std::size_t k = 0;
  double inertia = 0.0;
  double centrifugal = 0.0;
};

PairTerms pair_terms(const Coupling& coupling, const LinkMotion& m, std::size_t j, std::size_t k) {
  const double c = m.cosine[j] * m.cosine[k] + m.sine[j] * m.sine[k];
  const double s = m.sine[j] * m.cosine[k] - m.cosine[j] * m.sine[k];
  const double re = coupling.real[j][k];
  const double im = coupling.imaginary[j][k];
  return {j, k, re * c - im * s, re * s + im * c};
}

/// Forces of the pair j, k on each other:
///   force_j = H u_k + C w_k^2,  force_k = H u_j - C w_j^2,  dH = -C, dC = H by the angle a_j -
///   a_k.
void add_pair(const PairTerms& t, const LinkMotion& m, LinkForces& f) {
  const auto [j, k] = std::pair(t.j, t.k);
  const double wj = m.rate[j];
  const double wk = m.rate[k];
  const double uj = m.acceleration[j];
  const double uk = m.acceleration[k];
  f.value[j] += t.inertia * uk + t.centrifugal * wk * wk;
  f.value[k] += t.inertia * uj - t.centrifugal * wj * wj;
  const double turn_j = t.inertia * wk * wk - t.centrifugal * uk;
  const double turn_k = -t.inertia * wj * wj - t.centrifugal * uj;
  LinkSlope& of_j = f.slope[j];
  LinkSlope& of_k = f.slope[k];
  of_j.pitch[j] += turn_j;
  of_j.pitch[k] -= turn_j;
  of_k.pitch[j] += turn_k;
  of_k.pitch[k] -= turn_k;
  of_j.rate[k] += 2.0 * t.centrifugal * wk;
  of_k.rate[j] -= 2.0 * t.centrifugal * wj;
  of_j.acceleration[k] += t.inertia;
  of_k.acceleration[j] += t.inertia;
}

template <std::size_t kFirst>
void add_forces(const Coupling& coupling, const LinkMotion& m, LinkForces& f) {
  for (std::size_t j = kFirst; j < kPlanarLinks; ++j) {
    f.value[j] += coupling.real[j][j] * m.acceleration[j];
    f.slope[j].acceleration[j] += coupling.real[j][j];
    for (std::size_t k = j + 1; k < kPlanarLinks; ++k) {
      add_pair(pair_terms(coupling, m, j, k), m, f);
    }
  }
}

/// Second derivatives of weight_j force_j + weight_k force_k of one pair.
void add_pair_curvature(const PairTerms& t, const LinkMotion& m,
                        const model::LinkArray<double>& weight, LinkCurvature& c) {
  const auto [j, k] = std::pair(t.j, t.k);
  const double pj = weight[j];
  const double pk = weight[k];
  const double wj = m.rate[j];
  const double wk = m.rate[k];
  const double by_inertia = pj * m.acceleration[k] + pk * m.acceleration[j];
  const double by_centrifugal = pj * wk * wk - pk * wj * wj;
  const double turn = -t.inertia * by_inertia - t.centrifugal * by_centrifugal;
  c.pitch[j][j] += turn;
  c.pitch[k][k] += turn;
  c.pitch[j][k] -= turn;
  c.pitch[k][j] -= turn;
  const double rate_k = 2.0 * pj * t.inertia * wk;
  const double rate_j = -2.0 * pk * t.inertia * wj;
  c.pitch_rate[j][k] += rate_k;
  c.pitch_rate[k][k] -= rate_k;
  c.pitch_rate[j][j] += rate_j;
  c.pitch_rate[k][j] -= rate_j;
  c.pitch_acceleration[j][k] -= pj * t.centrifugal;
  c.pitch_acceleration[k][k] += pj * t.centrifugal;
  c.pitch_acceleration[j][j] -= pk * t.centrifugal;
  c.pitch_acceleration[k][j] += pk * t.centrifugal;
  c.rate[k] += 2.0 * pj * t.centrifugal;
  c.rate[j] -= 2.0 * pk * t.centrifugal;
}

template <std::size_t kFirst>
void add_curvature(const Coupling& coupling, const LinkMotion& m,
                   const model::LinkArray<double>& weight, LinkCurvature& c) {
  for (std::size_t j = kFirst; j < kPlanarLinks; ++j) {
    for (std::size_t k = j + 1; k < kPlanarLinks; ++k) {
      add_pair_curvature(pair_terms(coupling, m, j, k), m, weight, c);
    }
  }
}

/// M e_j of a link, turned by its pitch: the link's share of the CoM times the mass.
model::PlanarVector<double> share(const model::PlanarDynamics& dynamics, const LinkMotion& m,
                                  std::size_t j) {
  const double mass = dynamics.chain().total_mass();
  const auto e = dynamics.com_share(j);
  return {mass * (e.x * m.cosine[j] + e.z * m.sine[j]),
          mass * (e.z * m.cosine[j] - e.x * m.sine[j])};
}

}  // namespace

void LinkMotion::turn() {
  for (std::size_t j = 0; j < kPlanarLinks; ++j) {
    cosine[j] = std::cos(pitch[j]);
    sine[j] = std::sin(pitch[j]);
  }
}

void stance_forces(const model::PlanarDynamics& dynamics, const LinkMotion& motion,
                   LinkForces& forces, GroundForce& ground) {
  forces = {};
  ground = {};
  ground.value.z = dynamics.chain().total_mass() * model::kGravity;
  for (std::size_t j = kShank; j < kPlanarLinks; ++j) {
    const model::PlanarVector<double> r = share(dynamics, motion, j);
    const double w = motion.rate[j];
    const double u = motion.acceleration[j];
    ground.value.x += u * r.z - w * w * r.x;
    ground.value.z -= u * r.x + w * w * r.z;
    ground.slope_x.pitch[j] = -u * r.x - w * w * r.z;
    ground.slope_x.rate[j] = -2.0 * w * r.x;
    ground.slope_x.acceleration[j] = r.z;
    ground.slope_z.pitch[j] = -u * r.z + w * w * r.x;
    ground.slope_z.rate[j] = -2.0 * w * r.z;
    ground.slope_z.acceleration[j] = -r.x;
    forces.value[j] = -model::kGravity * r.x;
    forces.slope[j].pitch[j] = -model::kGravity * r.z;
  }
  add_forces<kShank>(dynamics.pinned(), motion, forces);
}

void flight_forces(const model::PlanarDynamics& dynamics, const LinkMotion& motion,
                   LinkForces& forces) {
  forces = {};
  add_forces<kFoot>(dynamics.free(), motion, forces);
}

void stance_curvature(const model::PlanarDynamics& dynamics, const LinkMotion& motion,
                      const LoadWeights& weights, LinkCurvature& curvature) {
  curvature = {};
  const double gx = weights.ground.x;
  const double gz = weights.ground.z;
  for (std::size_t j = kShank; j < kPlanarLinks; ++j) {
    const model::PlanarVector<double> r = share(dynamics, motion, j);
    const double w = motion.rate[j];
    const double u = motion.acceleration[j];
    curvature.pitch[j][j] = gx * (w * w * r.x - u * r.z) + gz * (u * r.x + w * w * r.z) +
                            model::kGravity * weights.force[j] * r.x;
    curvature.pitch_rate[j][j] = 2.0 * w * (gz * r.x - gx * r.z);
    curvature.pitch_acceleration[j][j] = -gx * r.x - gz * r.z;
    curvature.rate[j] = -2.0 * (gx * r.x + gz * r.z);
  }
  add_curvature<kShank>(dynamics.pinned(), motion, weights.force, curvature);
}

void flight_curvature(const model::PlanarDynamics& dynamics, const LinkMotion& motion,
                      const model::LinkArray<double>& weights, LinkCurvature& curvature) {
  curvature = {};
  add_curvature<kFoot>(dynamics.free(), motion, weights, curvature);
}

}  // namespace hopscotch::planner
