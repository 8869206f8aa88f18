#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstdint>

namespace hopscotch::sim {

/// Random numbers that are the same on every machine and standard library: splitmix64.
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}

  /// A stream of its own for each purpose, so that adding a draw to one does not shift the others.
  [[nodiscard]] static Random stream(std::uint64_t seed, std::uint64_t purpose) {
    Random mixed(seed ^ (purpose * 0xD1342543DE82EF95ULL));
    return Random(mixed.next());
  }

  /// In [-1, 1).
  [[nodiscard]] double uniform() { return static_cast<double>(next() >> 11) * 0x1.0p-52 - 1.0; }

  /// Zero mean, unit variance (polar method).
  [[nodiscard]] double normal() {
    for (;;) {
      const double u = uniform();
      const double v = uniform();
      const double s = u * u + v * v;
      if (s < 1.0 && s > 0.0) return u * std::sqrt(-2.0 * std::log(s) / s);
    }
  }

  template <int N>
  [[nodiscard]] Eigen::Vector<double, N> uniform_vector() {
    Eigen::Vector<double, N> result;
    for (int i = 0; i < N; ++i) result[i] = uniform();
    return result;
  }

  template <int N>
  [[nodiscard]] Eigen::Vector<double, N> normal_vector() {
    Eigen::Vector<double, N> result;
    for (int i = 0; i < N; ++i) result[i] = normal();
    return result;
  }

 private:
  std::uint64_t next() {
    state_ += 0x9E3779B97F4A7C15ULL;
    std::uint64_t z = state_;
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ULL;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBULL;
    return z ^ (z >> 31);
  }

  std::uint64_t state_;
};

}  // namespace hopscotch::sim
