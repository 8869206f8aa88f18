#include "model/planar_dynamics.hpp"

#include <complex>

namespace hopscotch::model {

namespace {

using Complex = std::complex<double>;

/// e_ij: CoM of link i as a sum of vectors of the links j from the ankle axis.
std::array<std::array<Complex, kPlanarLinks>, kPlanarLinks> com_paths(const PlanarChain& chain) {
  const auto com = [](const PlanarLink& link) { return Complex(link.com_x, link.com_z); };
  const auto along = [](const PlanarLink& link) { return Complex(0.0, link.length); };
  std::array<std::array<Complex, kPlanarLinks>, kPlanarLinks> e{};
  e[kFoot][kFoot] = com(chain.foot);
  e[kShank][kShank] = com(chain.shank);
  e[kThigh] = {0.0, along(chain.shank), com(chain.thigh), 0.0};
  e[kTrunk] = {0.0, along(chain.shank), along(chain.thigh), com(chain.trunk)};
  return e;
}

}  // namespace

PlanarDynamics::PlanarDynamics(const PlanarChain& chain) : chain_(chain) {
  const std::array<PlanarLink, kPlanarLinks> links{chain.foot, chain.shank, chain.thigh,
                                                   chain.trunk};
  const std::array<std::array<Complex, kPlanarLinks>, kPlanarLinks> e = com_paths(chain);
  const double mass = chain.total_mass();
  LinkArray<Complex> share{};
  for (std::size_t i = 0; i < kPlanarLinks; ++i) {
    for (std::size_t j = 0; j < kPlanarLinks; ++j) share[j] += links[i].mass / mass * e[i][j];
  }
  for (std::size_t j = 0; j < kPlanarLinks; ++j) {
    com_share_[j] = {share[j].real(), share[j].imag()};
    for (std::size_t k = 0; k < kPlanarLinks; ++k) {
      Complex pinned = j == k ? links[j].inertia : 0.0;
      for (std::size_t i = 0; i < kPlanarLinks; ++i) {
        pinned += links[i].mass * std::conj(e[i][j]) * e[i][k];
      }
      const Complex free = pinned - mass * std::conj(share[j]) * share[k];
      pinned_.real[j][k] = pinned.real();
      pinned_.imaginary[j][k] = pinned.imag();
      free_.real[j][k] = free.real();
      free_.imaginary[j][k] = free.imag();
    }
  }
}

}  // namespace hopscotch::model
