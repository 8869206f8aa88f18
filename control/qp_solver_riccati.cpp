#include "control/qp_solver_riccati.hpp"

#include <cstring>

#include "control/qp_solver_lanes.hpp"
#include "core/robot_layout.hpp"

namespace hopscotch::control::riccati {

namespace {

/// Cost-to-go 1/2 x'Px: columns of the velocities over [v; q], and the block of q. Both symmetric
/// blocks are kept whole.
struct CostToGo {
  alignas(16) Tall v;
  alignas(16) Square q;
};

/// A = C diag(1 / d_inverse) C' with unit lower C. Reads the lower triangle.
[[gnu::always_inline]] inline void factorise_symmetric(const Square& a, Square& c,
                                                       double (&d_inverse)[kWrench]) {
  Lanes<kWrench> column[kWrench];
  repeat<kWrench>([&](auto j) { column[j] = load<kWrench>(a[j]); });
  repeat<kWrench>([&](auto j) {
    d_inverse[j] = 1.0 / column[j][j];
    const Lanes<kWrench> unit = scaled(d_inverse[j], column[j]);
    repeat<kWrench - 1 - j>([&](auto i) {
      constexpr int kNext = j + 1 + i;
      subtract<kNext / 2>(unit[kNext], column[j], column[kNext]);
    });
    store(unit, c[j]);
    repeat<j>([&](auto i) { c[j][i] = 0.0; });
    c[j][j] = 1.0;
  });
}

/// X <- X C^-T for unit lower C; X has columns of 6 or 12 rows.
template <std::size_t Rows>
[[gnu::always_inline]] inline void divide_by_transposed(const Square& c,
                                                        double (&x)[kWrench][Rows]) {
  constexpr int kSize = static_cast<int>(Rows);
  repeat<kWrench>([&](auto j) {
    Lanes<kSize> column = load<kSize>(x[j]);
    repeat<j>([&](auto i) { subtract(c[i][j], load<kSize>(x[i]), column); });
    store(column, x[j]);
  });
}

/// x <- C^-1 x for unit lower C.
[[gnu::always_inline]] inline void divide(const Square& c, double (&x)[kWrench]) {
  repeat<kWrench>([&](auto i) {
    double value = x[i];
    repeat<i>([&](auto j) { value -= c[j][i] * x[j]; });
    x[i] = value;
  });
}

// GCC 12 at -O2 takes the subscripts below, all less than 6, to be out of bounds.
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Warray-bounds"
/// Copies the lower triangle of the first six rows to the upper.
template <std::size_t Rows>
[[gnu::always_inline]] inline void mirror(double (&columns)[kWrench][Rows]) {
  repeat<kWrench>([&](auto j) { repeat<j>([&](auto i) { columns[j][i] = columns[i][j]; }); });
}
#pragma GCC diagnostic pop

/// S = E W^-1 E': what the feet can do to the velocities, as a sum of nonnegative rank-one terms.
[[gnu::always_inline]] inline void compliance(const Step& step, const Elimination& elimination,
                                              Square& s) {
  alignas(16) double bent[core::kLegs][kWrench];
  alignas(16) double share[kInputs][kWrench];  // W^-1 E' once the normal columns are bent
  repeat<core::kLegs>([&](auto foot) {
    Lanes<kWrench> column = load<kWrench>(step.columns[kLanes + foot]);
    repeat<4>([&](auto i) {
      constexpr int kLane = 4 * foot + i;
      subtract(elimination.arrow[kLane], load<kWrench>(step.columns[kLane]), column);
      store(scaled(elimination.inverse[kLane], load<kWrench>(step.columns[kLane])), share[kLane]);
    });
    store(column, bent[foot]);
    store(scaled(elimination.inverse[kLanes + foot], column), share[kLanes + foot]);
  });
  repeat<kWrench>([&](auto j) {
    Lanes<kWrench> column = zero<kWrench>();
    repeat<core::kLegs>([&](auto foot) {
      add<j / 2>(share[kLanes + foot][j], load<kWrench>(bent[foot]), column);
      add<j / 2>(share[4 * foot][j], load<kWrench>(step.columns[4 * foot]), column);
      add<j / 2>(share[4 * foot + 1][j], load<kWrench>(step.columns[4 * foot + 1]), column);
      if constexpr (j >= 3) {  // moments do not move the CoM
        add<j / 2>(share[4 * foot + 2][j], load<kWrench>(step.columns[4 * foot + 2]), column);
        add<j / 2>(share[4 * foot + 3][j], load<kWrench>(step.columns[4 * foot + 3]), column);
      }
    });
    store(column, s[j]);
  });
  mirror(s);
}

/// Lower triangle of D^-1 + C' S C, in place of S.
[[gnu::always_inline]] inline void information(const Square& c, const double (&d_inverse)[kWrench],
                                               Square& s) {
  repeat<kWrench>([&](auto j) {
    Lanes<kWrench> column = load<kWrench>(s[j]);
    repeat<kWrench - 1 - j>([&](auto i) {
      constexpr int kNext = j + 1 + i;
      add<j / 2>(c[j][kNext], load<kWrench>(s[kNext]), column);
    });
    store(column, s[j]);
    repeat<kWrench - j>([&](auto n) {
      constexpr int kRow = j + n;
      double value = s[j][kRow];
      repeat<kWrench - 1 - kRow>([&](auto o) {
        constexpr int kNext = kRow + 1 + o;
        value += c[kRow][kNext] * column[kNext];
      });
      s[j][kRow] = value;
    });
    s[j][j] += d_inverse[j];
  });
}

/// The blocks of the cost-to-go before the kick, see kick_back().
[[gnu::always_inline]] inline void assemble(const Square& b, const Factor& factor, CostToGo& p) {
  repeat<kWrench>([&](auto j) {
    Lanes<kState> column = zero<kState>();
    Lanes<kWrench> corner = load<kWrench>(p.q[j]);
    repeat<kWrench>([&](auto i) {
      add<j / 2>(factor.g_inverse[i] * factor.z[i][j], load<kState>(factor.z[i]), column);
      add<j / 2>(factor.g_inverse[i] * factor.z[i][kWrench + j],
                 load<kWrench>(factor.z[i] + kWrench), corner);
      subtract<j / 2>(b[i][j], load<kWrench>(factor.bd[i]), corner);
    });
    store(column, p.v[j]);
    store(corner, p.q[j]);
  });
  mirror(p.v);
  mirror(p.q);
}

/// Takes the cost-to-go from behind the kick to before it. In information form, so that nothing
/// large is subtracted and a singular S (one foot) needs no special case:
///   Pvv <- (Pvv^-1 + S)^-1 = Y G^-1 Y',  Pqv <- BL G^-1 Y',  Pqq <- Pqq - B D^-1 B' + BL G^-1 BL'
/// with Y = C L^-T, B = Pqv C^-T, BL = B D^-1 L^-T.
void kick_back(const Step& step, const Elimination& elimination, Factor& factor, CostToGo& p) {
  alignas(16) Square vv;
  alignas(16) Square b;
  repeat<kWrench>([&](auto j) {
    store(load<kWrench>(p.v[j]), vv[j]);
    store(load<kWrench>(p.v[j] + kWrench), b[j]);
  });
  factorise_symmetric(vv, factor.c, factor.d_inverse);
  alignas(16) Square s;
  compliance(step, elimination, s);
  information(factor.c, factor.d_inverse, s);
  factorise_symmetric(s, factor.l, factor.g_inverse);

  divide_by_transposed(factor.c, b);
  repeat<kWrench>([&](auto j) {
    const Lanes<kWrench> column = scaled(factor.d_inverse[j], load<kWrench>(b[j]));
    store(column, factor.bd[j]);
    store(column, factor.z[j] + kWrench);
    store(load<kWrench>(factor.c[j]), factor.z[j]);
  });
  divide_by_transposed(factor.l, factor.z);
  assemble(b, factor, p);
  std::memcpy(factor.after_kick, p.v, sizeof(p.v));
}

/// Takes the cost-to-go from behind a drift q += E v to before it:
///   Pqv <- Pqv + Pqq E,   Pvv <- Pvv + F + F'  with  F = E' (Pqv + Pqq E / 2).
void drift_back(const Drift& drift, CostToGo& p) {
  alignas(16) Square f;
  Lanes<kWrench> rate[3];  // rows of the rate, behind three zeros
  repeat<3>([&](auto m) { rate[m] = load<kWrench>(drift.padded[m]); });
  repeat<kWrench>([&](auto j) {
    Lanes<kWrench> moved;
    if constexpr (j < 3) {
      moved = scaled(drift.time, load<kWrench>(p.q[j]));
    } else {
      moved = scaled(drift.rate[j - 3][0], load<kWrench>(p.q[3]));
      add(drift.rate[j - 3][1], load<kWrench>(p.q[4]), moved);
      add(drift.rate[j - 3][2], load<kWrench>(p.q[5]), moved);
    }
    Lanes<kWrench> qv = load<kWrench>(p.v[j] + kWrench);
    Lanes<kWrench> half = qv;
    add(0.5, moved, half);
    add(1.0, moved, qv);
    store(qv, p.v[j] + kWrench);
    Lanes<kWrench> column;
    column.part[0] = Pair{drift.time, drift.time} * half.part[0];
    column.part[1] = Pair{drift.time, 0.0} * half.part[1];
    column.part[2] = Pair{0.0, 0.0};
    repeat<3>([&](auto m) { add<1>(half[3 + m], rate[m], column); });
    store(column, f[j]);
  });
  repeat<kWrench>([&](auto j) {
    Lanes<kWrench> column = load<kWrench>(p.v[j]);
    const Lanes<kWrench> own = load<kWrench>(f[j]);
    repeat<3>([&](auto i) { column.part[i] += own.part[i] + Pair{f[2 * i][j], f[2 * i + 1][j]}; });
    store(column, p.v[j]);
  });
}

/// Gradient of the cost-to-go over a drift: pv += E' pq.
[[gnu::always_inline]] inline void drift_back(const Drift& drift, double (&p)[kState]) {
  repeat<3>([&](auto i) {
    p[i] += drift.time * p[kWrench + i];
    p[3 + i] += drift.rate[i][0] * p[9] + drift.rate[i][1] * p[10] + drift.rate[i][2] * p[11];
  });
}

[[gnu::always_inline]] inline void drift_forward(const Drift& drift, double (&x)[kState]) {
  repeat<3>([&](auto i) {
    x[kWrench + i] += drift.time * x[i];
    x[9 + i] += drift.rate[0][i] * x[3] + drift.rate[1][i] * x[4] + drift.rate[2][i] * x[5];
  });
}

/// W^-1 r.
[[gnu::always_inline]] inline void eliminate(const Elimination& elimination,
                                             const double (&r)[kInputs], double (&z)[kInputs]) {
  repeat<core::kLegs>([&](auto foot) {
    const Lanes<4> lanes = load<4>(r + 4 * foot);
    const Lanes<4> arrow = load<4>(elimination.arrow + 4 * foot);
    const Lanes<4> inverse = load<4>(elimination.inverse + 4 * foot);
    const double normal =
        (r[kLanes + foot] - dot(arrow, lanes)) * elimination.inverse[kLanes + foot];
    Lanes<4> out;
    repeat<2>([&](auto i) { out.part[i] = lanes.part[i] * inverse.part[i]; });
    subtract(normal, arrow, out);
    store(out, z + 4 * foot);
    z[kLanes + foot] = normal;
  });
}

/// E u.
[[gnu::always_inline]] inline Lanes<kWrench> pushed(const Step& step,
                                                    const double (&input)[kInputs]) {
  Lanes<kWrench> forces = zero<kWrench>();
  Lanes<kWrench> moments = zero<kWrench>();  // they have no linear part
  repeat<core::kLegs>([&](auto foot) {
    constexpr int kLane = 4 * foot;
    add(input[kLane], load<kWrench>(step.columns[kLane]), forces);
    add(input[kLane + 1], load<kWrench>(step.columns[kLane + 1]), forces);
    add(input[kLanes + foot], load<kWrench>(step.columns[kLanes + foot]), forces);
    add<1>(input[kLane + 2], load<kWrench>(step.columns[kLane + 2]), moments);
    add<1>(input[kLane + 3], load<kWrench>(step.columns[kLane + 3]), moments);
  });
  add<1>(1.0, moments, forces);
  return forces;
}

/// E' y.
[[gnu::always_inline]] inline void pull(const Step& step, const double* y,
                                        double (&input)[kInputs]) {
  Lanes<kInputs> sum = scaled(y[0], load<kInputs>(step.rows[0]));
  repeat<kWrench - 1>([&](auto i) { add(y[1 + i], load<kInputs>(step.rows[1 + i]), sum); });
  store(sum, input);
}

/// Gradient of the cost-to-go over the kick of step k. Leaves the costate right behind the kick,
/// for an unchanged state, in `costate` and W^-1 r in `eliminated`.
[[gnu::always_inline]] inline void kick_back(const Sweep& sweep, int k, Direction& direction,
                                             double (&p)[kState]) {
  const Step& step = sweep.step[k];
  const Factor& factor = sweep.factor[k];
  eliminate(sweep.elimination[k], direction.input_gradient[k], direction.eliminated[k]);
  // -W^-1 r alone would change the velocities by minus this.
  const Lanes<kWrench> own_kick = pushed(step, direction.eliminated[k]);
  alignas(16) double t[kWrench];
  store(load<kWrench>(p), t);
  divide(factor.c, t);
  alignas(16) double z[kWrench];
  repeat<kWrench>([&](auto i) { z[i] = factor.d_inverse[i] * t[i]; });
  divide(factor.l, z);
  Lanes<kState> out = zero<kState>();
  repeat<3>([&](auto i) { out.part[3 + i] = load<kWrench>(p + kWrench).part[i]; });
  Lanes<kWrench> q_part = zero<kWrench>();
  repeat<kWrench>([&](auto i) {
    const double weight = factor.g_inverse[i] * (z[i] - dot(load<kWrench>(factor.z[i]), own_kick));
    add(weight, load<kState>(factor.z[i]), out);
    subtract(t[i], load<kWrench>(factor.bd[i]), q_part);
  });
  repeat<3>([&](auto i) { out.part[3 + i] += q_part.part[i]; });
  store(out, p);
  repeat<3>([&](auto i) {
    direction.costate[k][2 * i] = out.part[i][0];
    direction.costate[k][2 * i + 1] = out.part[i][1];
  });
}

/// Inputs of step k for the state change `x` at its start.
[[gnu::always_inline]] inline void choose_inputs(const Sweep& sweep, int k,
                                                 const double (&x)[kState], Direction& direction) {
  // The costate sees the state after the first drift.
  alignas(16) double moved[kState];
  store(load<kState>(x), moved);
  drift_forward(sweep.step[k].before, moved);
  const Lanes<kState> state = load<kState>(moved);
  alignas(16) double y[kWrench];
  repeat<kWrench>([&](auto j) {
    y[j] = direction.costate[k][j] + dot(load<kState>(sweep.factor[k].after_kick[j]), state);
  });
  alignas(16) double gradient[kInputs];
  pull(sweep.step[k], y, gradient);
  alignas(16) double answer[kInputs];
  eliminate(sweep.elimination[k], gradient, answer);
  for (int i = 0; i < kInputs; ++i) {
    direction.input[k][i] = -answer[i] - direction.eliminated[k][i];
  }
}

}  // namespace

void push(const Step& step, const double (&input)[kInputs], double (&kick)[kWrench]) noexcept {
  store(pushed(step, input), kick);
}

void advance(const Step& step, const double (&kick)[kWrench], double (&state)[kState]) noexcept {
  drift_forward(step.before, state);
  for (int i = 0; i < kWrench; ++i) state[i] += kick[i];
  if (step.after.time > 0.0) drift_forward(step.after, state);
}

void factorise(Sweep& sweep) noexcept {
  alignas(16) CostToGo p = {};
  for (int k = sweep.steps - 1; k >= 0; --k) {
    const Step& step = sweep.step[k];
    for (int i = 0; i < kWrench; ++i) {
      p.v[i][i] += sweep.state_weight[i];
      p.q[i][i] += sweep.state_weight[kWrench + i];
    }
    if (step.after.time > 0.0) drift_back(step.after, p);
    if (step.contact) kick_back(step, sweep.elimination[k], sweep.factor[k], p);
    if (k > 0) drift_back(step.before, p);
  }
}

void solve(const Sweep& sweep, Direction& direction) noexcept {
  alignas(16) double p[kState] = {};
  for (int k = sweep.steps - 1; k >= 0; --k) {
    const Step& step = sweep.step[k];
    for (int i = 0; i < kState; ++i) p[i] += direction.state_gradient[k][i];
    if (step.after.time > 0.0) drift_back(step.after, p);
    if (step.contact) kick_back(sweep, k, direction, p);
    if (k > 0) drift_back(step.before, p);
  }
  alignas(16) double x[kState] = {};
  for (int k = 0; k < sweep.steps; ++k) {
    const Step& step = sweep.step[k];
    alignas(16) double kick[kWrench] = {};
    if (step.contact) {
      choose_inputs(sweep, k, x, direction);
      push(step, direction.input[k], kick);
    }
    advance(step, kick, x);
    for (int i = 0; i < kState; ++i) direction.state[k][i] = x[i];
  }
}

void adjoint(const Sweep& sweep, const double (&state_gradient)[kMaxSteps][kState],
             double (&input_gradient)[kMaxSteps][kInputs]) noexcept {
  alignas(16) double p[kState] = {};
  for (int k = sweep.steps - 1; k >= 0; --k) {
    const Step& step = sweep.step[k];
    for (int i = 0; i < kState; ++i) p[i] += state_gradient[k][i];
    if (step.after.time > 0.0) drift_back(step.after, p);
    pull(step, p, input_gradient[k]);
    if (k > 0) drift_back(step.before, p);
  }
}

}  // namespace hopscotch::control::riccati
