#pragma once

#include <cstddef>
#include <cstring>
#include <utility>

/// Internal to qp_solver: short vectors that live in registers. Pairs of doubles, which every
/// x86-64 and ARMv8 machine has, so that results do not depend on the machine's newer instructions.
namespace hopscotch::control::riccati {

using Pair = double __attribute__((vector_size(16)));

/// N doubles, N even, as values.
template <int N>
struct Lanes {
  static_assert(N % 2 == 0);
  Pair part[static_cast<std::size_t>(N / 2)];

  double operator[](int i) const { return part[i / 2][i % 2]; }
};

/// Calls f(integral_constant) for 0 .. N - 1, unrolled, so that every index is a constant.
template <int N, typename F>
[[gnu::always_inline]] inline void repeat(F&& f) {
  [&]<int... I>(std::integer_sequence<int, I...>) __attribute__((always_inline)) {
    (f(std::integral_constant<int, I>{}), ...);
  }
  (std::make_integer_sequence<int, N>{});
}

/// @param from Aligned to 16 bytes.
template <int N>
[[gnu::always_inline]] inline Lanes<N> load(const double* from) {
  Lanes<N> result;
  std::memcpy(&result, __builtin_assume_aligned(from, 16), sizeof(result));
  return result;
}

template <int N>
[[gnu::always_inline]] inline void store(const Lanes<N>& from, double* to) {
  std::memcpy(__builtin_assume_aligned(to, 16), &from, sizeof(from));
}

template <int N>
[[gnu::always_inline]] inline Lanes<N> zero() {
  Lanes<N> result;
  repeat<N / 2>([&](auto i) { result.part[i] = Pair{0.0, 0.0}; });
  return result;
}

/// to += factor * from, in the pairs from number First on.
template <int First = 0, int N>
[[gnu::always_inline]] inline void add(double factor, const Lanes<N>& from, Lanes<N>& to) {
  const Pair both = {factor, factor};
  repeat<N / 2 - First>([&](auto i) { to.part[First + i] += both * from.part[First + i]; });
}

template <int First = 0, int N>
[[gnu::always_inline]] inline void subtract(double factor, const Lanes<N>& from, Lanes<N>& to) {
  const Pair both = {factor, factor};
  repeat<N / 2 - First>([&](auto i) { to.part[First + i] -= both * from.part[First + i]; });
}

template <int N>
[[gnu::always_inline]] inline Lanes<N> scaled(double factor, const Lanes<N>& from) {
  const Pair both = {factor, factor};
  Lanes<N> result;
  repeat<N / 2>([&](auto i) { result.part[i] = both * from.part[i]; });
  return result;
}

template <int N>
[[gnu::always_inline]] inline double dot(const Lanes<N>& a, const Lanes<N>& b) {
  Pair sum = a.part[0] * b.part[0];
  repeat<N / 2 - 1>([&](auto i) { sum += a.part[1 + i] * b.part[1 + i]; });
  return sum[0] + sum[1];
}

}  // namespace hopscotch::control::riccati
