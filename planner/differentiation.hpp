#pragma once

#include <array>
#include <cmath>
#include <cstddef>

namespace hopscotch::planner {

/// Forward differentiation over a handful of local variables: the physics is written once, for any
/// scalar, and these two scalars carry its exact derivatives along. No allocation, no branches.

/// Value and gradient with respect to N local variables.
template <std::size_t N>
struct FirstOrder {
  static constexpr std::size_t kSize = N;
  double value = 0.0;
  std::array<double, N> gradient{};

  FirstOrder() = default;
  FirstOrder(double constant) : value(constant) {}  // NOLINT(google-explicit-constructor)

  static FirstOrder variable(double value, int which) {
    FirstOrder x(value);
    x.gradient[static_cast<std::size_t>(which)] = 1.0;
    return x;
  }
};

/// Value, gradient and Hessian (lower triangle, row by row) with respect to N local variables.
template <std::size_t N>
struct SecondOrder {
  static constexpr std::size_t kSize = N;
  static constexpr std::size_t kTriangle = N * (N + 1) / 2;
  double value = 0.0;
  std::array<double, N> gradient{};
  std::array<double, kTriangle> hessian{};

  SecondOrder() = default;
  SecondOrder(double constant) : value(constant) {}  // NOLINT(google-explicit-constructor)

  static SecondOrder variable(double value, int which) {
    SecondOrder x(value);
    x.gradient[static_cast<std::size_t>(which)] = 1.0;
    return x;
  }
};

namespace detail {

/// out = fa a + fb b
template <std::size_t N>
inline void combine(std::array<double, N>& out, double fa, const std::array<double, N>& a,
                    double fb, const std::array<double, N>& b) {
  for (std::size_t i = 0; i < N; ++i) out[i] = fa * a[i] + fb * b[i];
}

}  // namespace detail

// ---- first order ----

template <std::size_t N>
FirstOrder<N> operator+(const FirstOrder<N>& a, const FirstOrder<N>& b) {
  FirstOrder<N> r(a.value + b.value);
  detail::combine(r.gradient, 1.0, a.gradient, 1.0, b.gradient);
  return r;
}
template <std::size_t N>
FirstOrder<N> operator-(const FirstOrder<N>& a, const FirstOrder<N>& b) {
  FirstOrder<N> r(a.value - b.value);
  detail::combine(r.gradient, 1.0, a.gradient, -1.0, b.gradient);
  return r;
}
template <std::size_t N>
FirstOrder<N> operator*(const FirstOrder<N>& a, const FirstOrder<N>& b) {
  FirstOrder<N> r(a.value * b.value);
  detail::combine(r.gradient, b.value, a.gradient, a.value, b.gradient);
  return r;
}
/// f(a) from f, f' (and f'', which first order does not need) at a.value.
template <std::size_t N>
FirstOrder<N> compose(const FirstOrder<N>& a, double f, double f1, double /*f2*/) {
  FirstOrder<N> r(f);
  for (std::size_t i = 0; i < N; ++i) r.gradient[i] = f1 * a.gradient[i];
  return r;
}

// ---- second order ----

template <std::size_t N>
SecondOrder<N> operator+(const SecondOrder<N>& a, const SecondOrder<N>& b) {
  SecondOrder<N> r(a.value + b.value);
  detail::combine(r.gradient, 1.0, a.gradient, 1.0, b.gradient);
  detail::combine(r.hessian, 1.0, a.hessian, 1.0, b.hessian);
  return r;
}
template <std::size_t N>
SecondOrder<N> operator-(const SecondOrder<N>& a, const SecondOrder<N>& b) {
  SecondOrder<N> r(a.value - b.value);
  detail::combine(r.gradient, 1.0, a.gradient, -1.0, b.gradient);
  detail::combine(r.hessian, 1.0, a.hessian, -1.0, b.hessian);
  return r;
}
template <std::size_t N>
SecondOrder<N> operator*(const SecondOrder<N>& a, const SecondOrder<N>& b) {
  SecondOrder<N> r(a.value * b.value);
  detail::combine(r.gradient, b.value, a.gradient, a.value, b.gradient);
  std::size_t k = 0;
  for (std::size_t i = 0; i < N; ++i) {
    const double ai = a.gradient[i];
    const double bi = b.gradient[i];
    for (std::size_t j = 0; j <= i; ++j, ++k) {
      r.hessian[k] =
          b.value * a.hessian[k] + a.value * b.hessian[k] + ai * b.gradient[j] + bi * a.gradient[j];
    }
  }
  return r;
}
template <std::size_t N>
SecondOrder<N> compose(const SecondOrder<N>& a, double f, double f1, double f2) {
  SecondOrder<N> r(f);
  std::size_t k = 0;
  for (std::size_t i = 0; i < N; ++i) {
    r.gradient[i] = f1 * a.gradient[i];
    const double second = f2 * a.gradient[i];
    for (std::size_t j = 0; j <= i; ++j, ++k) {
      r.hessian[k] = f1 * a.hessian[k] + second * a.gradient[j];
    }
  }
  return r;
}

// ---- both ----

template <typename T>
concept Differentiable = requires {
  T::kSize;
};

template <Differentiable T>
T operator+(const T& a, double b) {
  T r = a;
  r.value += b;
  return r;
}
template <Differentiable T>
T operator+(double a, const T& b) {
  return b + a;
}
template <Differentiable T>
T operator-(const T& a, double b) {
  return a + (-b);
}
template <std::size_t N>
FirstOrder<N> operator*(const FirstOrder<N>& a, double b) {
  return compose(a, a.value * b, b, 0.0);
}
template <std::size_t N>
SecondOrder<N> operator*(const SecondOrder<N>& a, double b) {
  SecondOrder<N> r(a.value * b);
  for (std::size_t i = 0; i < a.gradient.size(); ++i) r.gradient[i] = b * a.gradient[i];
  for (std::size_t i = 0; i < a.hessian.size(); ++i) r.hessian[i] = b * a.hessian[i];
  return r;
}
template <Differentiable T>
T operator*(double a, const T& b) {
  return b * a;
}
template <Differentiable T>
T operator-(const T& a) {
  return a * -1.0;
}
template <Differentiable T>
T operator-(double a, const T& b) {
  return -b + a;
}
template <Differentiable T>
T sin(const T& a) {
  const double s = std::sin(a.value);
  return compose(a, s, std::cos(a.value), -s);
}
template <Differentiable T>
T cos(const T& a) {
  const double c = std::cos(a.value);
  return compose(a, c, -std::sin(a.value), -c);
}

/// f(x) of a plain number, in the form that `compose` has for the other scalars.
inline double compose(double /*x*/, double f, double /*f1*/, double /*f2*/) {
  return f;
}

/// Plain value of any scalar.
inline double value_of(double x) {
  return x;
}
template <Differentiable T>
double value_of(const T& x) {
  return x.value;
}

}  // namespace hopscotch::planner
