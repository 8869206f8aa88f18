#include "planner/chain_knots.hpp"

#include <cmath>

#include "planner/link_fold.hpp"

namespace hopscotch::planner {

namespace {

using model::kPlanarLinks;
using model::LinkArray;
using LinkTable = std::array<LinkArray<double>, kPlanarLinks>;
constexpr std::size_t kDof = kFlightDof;

LinkArray<double> flight_links(const double* y) {
  return links_from_coordinates(y[0], y[1], y[2], y[3]);
}

/// Vectors of the links from the CoM to one point of the leg, turned by their pitches.
struct PointPath {
  LinkArray<double> x{};
  LinkArray<double> z{};
  double look_back = 0.0;  ///< The terrain is taken so far behind the point [m].
};

PointPath path_from_com(const model::PlanarDynamics& dynamics, const LinkArray<double>& a) {
  PointPath path;
  for (std::size_t l = 0; l < kPlanarLinks; ++l) {
    const auto share = dynamics.com_share(l);
    const auto r = model::PlanarDynamics::turned(-share.x, -share.z, a[l]);
    path.x[l] = r.x;
    path.z[l] = r.z;
  }
  return path;
}

/// Where the CoM is on its parabola, with its derivatives by (x, z, vx, vz, step).
struct Centre {
  const SmoothTerrain& terrain;
  double time = 0.0;
  double knot = 0.0;
  double x = 0.0;
  double z = 0.0;
  std::array<double, 5> x_slope{};
  std::array<double, 5> z_slope{};

  Centre(const ClearanceLaw& law, const double* v)
      : terrain(law.terrain), time(law.knot * v[4]), knot(law.knot) {
    x = v[0] + v[2] * time;
    z = v[1] + v[3] * time - 0.5 * model::kGravity * time * time;
    x_slope = {1.0, 0.0, time, 0.0, knot * v[2]};
    z_slope = {0.0, 1.0, 0.0, time, knot * (v[3] - model::kGravity * time)};
  }
};

/// Height of one point above the terrain; `slope` is its row of the terms.
void expand_point(const Centre& centre, const PointPath& path, double multiplier,
                  std::array<double, 9>& slope, ClearanceTerms& terms) {
  double x = centre.x - path.look_back;
  for (const double each : path.x) x += each;
  const TerrainPoint ground = centre.terrain.at(x);
  LinkArray<double> by_pitch{};
  LinkTable bend{};
  for (std::size_t l = 0; l < kPlanarLinks; ++l) {
    by_pitch[l] = -path.x[l] - ground.slope * path.z[l];
    bend[l][l] = multiplier * (ground.slope * path.x[l] - path.z[l]);
  }
  std::array<double, 9> x_slope{};
  fold<kFlightDof>(by_pitch, slope.data());
  fold<kFlightDof>(path.z, x_slope.data());
  for (std::size_t i = 0; i < 5; ++i) {
    slope[kDof + i] = centre.z_slope[i] - ground.slope * centre.x_slope[i];
    x_slope[kDof + i] = centre.x_slope[i];
  }
  if (multiplier == 0.0) return;
  const auto folded = folded_table<kFlightDof>(bend);
  for (std::size_t i = 0; i < kDof; ++i) {
    for (std::size_t j = 0; j < kDof; ++j) terms.hessian[i][j] += folded[i][j];
  }
  const double curve = multiplier * ground.curvature;
  for (std::size_t i = 0; i < 9; ++i) {
    for (std::size_t j = 0; j < 9; ++j) terms.hessian[i][j] -= curve * x_slope[i] * x_slope[j];
  }
  const double along = -multiplier * ground.slope * centre.knot;
  const double up = multiplier * centre.knot;
  terms.hessian[kDof + 2][kDof + 4] += along;
  terms.hessian[kDof + 4][kDof + 2] += along;
  terms.hessian[kDof + 3][kDof + 4] += up;
  terms.hessian[kDof + 4][kDof + 3] += up;
  terms.hessian[kDof + 4][kDof + 4] -= multiplier * model::kGravity * centre.knot * centre.knot;
}

}  // namespace

void expand_momentum(const model::PlanarDynamics& dynamics, const std::array<double, 8>& knot,
                     double multiplier, MomentumTerms& terms) {
  const model::PlanarDynamics::Coupling& coupling = dynamics.free();
  const LinkArray<double> a = flight_links(knot.data());
  const LinkArray<double> w = flight_links(knot.data() + kDof);
  LinkArray<double> by_pitch{};
  LinkArray<double> by_rate{};
  LinkTable pitch{};
  LinkTable pitch_rate{};
  for (std::size_t j = 0; j < kPlanarLinks; ++j) {
    by_rate[j] += coupling.real[j][j];
    for (std::size_t k = j + 1; k < kPlanarLinks; ++k) {
      const double c = std::cos(a[j] - a[k]);
      const double s = std::sin(a[j] - a[k]);
      const double inertia = coupling.real[j][k] * c - coupling.imaginary[j][k] * s;
      const double turn = -(coupling.real[j][k] * s + coupling.imaginary[j][k] * c);
      const double sum = w[j] + w[k];
      by_rate[j] += inertia;
      by_rate[k] += inertia;
      by_pitch[j] += turn * sum;
      by_pitch[k] -= turn * sum;
      pitch[j][j] -= inertia * sum;
      pitch[k][k] -= inertia * sum;
      pitch[j][k] += inertia * sum;
      pitch[k][j] += inertia * sum;
      pitch_rate[j][j] += turn;
      pitch_rate[j][k] += turn;
      pitch_rate[k][j] -= turn;
      pitch_rate[k][k] -= turn;
    }
  }
  fold<kFlightDof>(by_pitch, terms.slope.data());
  fold<kFlightDof>(by_rate, terms.slope.data() + kDof);
  const auto pitches = folded_table<kFlightDof>(pitch);
  const auto mixed = folded_table<kFlightDof>(pitch_rate);
  for (std::size_t i = 0; i < kDof; ++i) {
    for (std::size_t j = 0; j < kDof; ++j) {
      terms.hessian[i][j] = multiplier * pitches[i][j];
      terms.hessian[i][kDof + j] = terms.hessian[kDof + j][i] = multiplier * mixed[i][j];
      terms.hessian[kDof + i][kDof + j] = 0.0;
    }
  }
}

void expand_clearance(const ClearanceLaw& law, const std::array<double, 9>& x,
                      const std::array<double, ClearanceLaw::kRowCount>& multipliers,
                      ClearanceTerms& terms) {
  terms.hessian = {};
  const LinkArray<double> a = flight_links(x.data());
  const Centre centre(law, x.data() + kDof);
  const PointPath com = path_from_com(law.dynamics, a);
  const auto points = ClearanceLaw::points(law.dynamics, a);
  for (std::size_t p = 0; p < points.size(); ++p) {
    const std::size_t link = p < ClearanceLaw::kFootRows ? model::kFoot : model::kShank;
    PointPath path = com;
    path.x[link] += points[p].x;
    path.z[link] += points[p].z;
    path.look_back = ClearanceLaw::look_back(p);
    expand_point(centre, path, multipliers[p], terms.slope[p], terms);
  }
}

}  // namespace hopscotch::planner
