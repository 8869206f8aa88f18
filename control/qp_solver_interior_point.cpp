#include "control/qp_solver_interior_point.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace hopscotch::control::riccati {

namespace {

/// Share of the way to the nearest bound that a step takes.
constexpr double kToBoundary = 0.99;

/// Both normal forces, once per lane.
inline void spread(const double (&input)[kInputs], double (&normal)[kLanes]) {
  for (int i = 0; i < kLanes; ++i) normal[i] = input[kLanes + i / 4];
}

/// A u for the rows of one step, without the constant of the tops.
inline void rows_of(const double (&bound)[kTop], const double (&active)[kRows],
                    const double (&input)[kInputs], double (&rows)[kRows]) {
  double normal[kLanes];
  spread(input, normal);
  for (int i = 0; i < kLanes; ++i) {
    rows[i] = active[i] * (bound[i] * normal[i] - input[i]);
    rows[kLanes + i] = active[kLanes + i] * (bound[kLanes + i] * normal[i] + input[i]);
  }
  for (int foot = 0; foot < 2; ++foot)
    rows[kTop + foot] = -active[kTop + foot] * input[kLanes + foot];
}

/// input -= A' rows; `rows` is 0 where a row does not exist.
inline void subtract_transposed(const double (&bound)[kTop], const double (&rows)[kRows],
                                double (&input)[kInputs]) {
  double normal[kLanes];
  for (int i = 0; i < kLanes; ++i) {
    input[i] += rows[i] - rows[kLanes + i];
    normal[i] = bound[i] * rows[i] + bound[kLanes + i] * rows[kLanes + i];
  }
  for (int foot = 0; foot < 2; ++foot) {
    const double* n = normal + 4 * foot;
    input[kLanes + foot] += rows[kTop + foot] - ((n[0] + n[1]) + (n[2] + n[3]));
  }
}

/// Closed-form inverse of W = R + A' D A of one step. The Schur complement of each normal force is
/// written as a sum of nonnegative terms, so that nothing cancels.
inline void eliminate_step(const double (&bound)[kTop], const double (&input_weight)[kInputs],
                           const double (&active)[kRows], const double (&weight)[kRows],
                           Elimination& out) {
  double schur[kLanes];
  for (int i = 0; i < kLanes; ++i) {
    const double up = bound[i];
    const double low = bound[kLanes + i];
    const double d_up = weight[i];
    const double d_low = weight[kLanes + i];
    const double r = input_weight[i];
    // Lanes of a foot without contact have no columns, so their inverse is never seen: no branch.
    const double inverse = 1.0 / (r + d_up + d_low);
    out.inverse[i] = inverse;
    out.arrow[i] = (low * d_low - up * d_up) * inverse;
    schur[i] = (r * (up * up * d_up + low * low * d_low) + d_up * d_low * (up + low) * (up + low)) *
               inverse;
  }
  for (int foot = 0; foot < 2; ++foot) {
    const double* s = schur + 4 * foot;
    out.inverse[kLanes + foot] =
        1.0 / (input_weight[kLanes + foot] + weight[kTop + foot] + ((s[0] + s[1]) + (s[2] + s[3])));
  }
  for (int i = 0; i < kLanes; ++i) {
    const double contact = active[kTop + i / 4];
    out.inverse[i] *= contact;
    out.arrow[i] *= contact;
  }
  for (int foot = 0; foot < 2; ++foot) out.inverse[kLanes + foot] *= active[kTop + foot];
}

}  // namespace

void InteriorPoint::roll_out() noexcept {
  alignas(16) double x[kState];
  std::copy(x0, x0 + kState, x);
  for (int k = 0; k < sweep.steps; ++k) {
    alignas(16) double kick[kWrench];
    push(sweep.step[k], input[k], kick);
    for (int i = 0; i < kWrench; ++i) kick[i] += velocity_gain[k][i];
    advance(sweep.step[k], kick, x);
    for (int i = 0; i < kState; ++i) error[k][i] = x[i] - target[k][i];
    rows_of(bound, active[k], input[k], slack[k]);
    for (int i = 0; i < kTop; ++i) slack[k][i] += 1.0 - active[k][i];
    for (int i = kTop; i < kRows; ++i) {
      slack[k][i] += active[k][i] * top + (1.0 - active[k][i]);
    }
  }
}

void InteriorPoint::cost_gradient(InputTable& gradient) noexcept {
  for (int k = 0; k < sweep.steps; ++k) {
    for (int i = 0; i < kState; ++i) {
      direction_.state_gradient[k][i] = sweep.state_weight[i] * error[k][i];
    }
  }
  adjoint(sweep, direction_.state_gradient, gradient);
  for (int k = 0; k < sweep.steps; ++k) {
    for (int i = 0; i < kInputs; ++i) {
      gradient[k][i] += input_weight[i] * (input[k][i] - reference[k][i]);
    }
  }
}

double InteriorPoint::lagrangian_gradient(const InputTable& gradient) const noexcept {
  double largest = 0.0;
  for (int k = 0; k < sweep.steps; ++k) {
    double value[kInputs];
    double rows[kRows];
    std::copy(gradient[k], gradient[k] + kInputs, value);
    for (int i = 0; i < kRows; ++i) rows[i] = active[k][i] * multiplier[k][i];
    subtract_transposed(bound, rows, value);
    for (int i = 0; i < kInputs; ++i) {
      const double contact = active[k][kTop + (i < kLanes ? i / 4 : i - kLanes)];
      largest = std::max(largest, contact * std::abs(value[i]));
    }
  }
  return largest;
}

InteriorPoint::Measure InteriorPoint::measure() const noexcept {
  double products[kRows] = {};
  double states[kState] = {};
  double inputs[kInputs] = {};
  for (int k = 0; k < sweep.steps; ++k) {
    for (int i = 0; i < kState; ++i) states[i] += error[k][i] * error[k][i];
    if (!sweep.step[k].contact) continue;
    for (int i = 0; i < kRows; ++i) products[i] += active[k][i] * slack[k][i] * multiplier[k][i];
    for (int i = 0; i < kInputs; ++i) {
      const double change = input[k][i] - reference[k][i];
      inputs[i] += change * change;
    }
  }
  Measure result;
  for (const double product : products) result.complementarity += product;
  for (int i = 0; i < kState; ++i) result.cost += 0.5 * sweep.state_weight[i] * states[i];
  for (int i = 0; i < kInputs; ++i) result.cost += 0.5 * input_weight[i] * inputs[i];
  return result;
}

void InteriorPoint::eliminate_rows() noexcept {
  for (int k = 0; k < sweep.steps; ++k) {
    if (!sweep.step[k].contact) continue;
    for (int i = 0; i < kRows; ++i) {
      const double inverse = 1.0 / (slack[k][i] * multiplier[k][i]);
      slack_inverse_[k][i] = multiplier[k][i] * inverse;
      multiplier_inverse_[k][i] = slack[k][i] * inverse;
      weight_[k][i] = active[k][i] * multiplier[k][i] * slack_inverse_[k][i];
    }
    eliminate_step(bound, input_weight, active[k], weight_[k], sweep.elimination[k]);
  }
}

/// Solves the Newton system for the multipliers of `aim_`.
void InteriorPoint::solve_direction() noexcept {
  for (int k = 0; k < sweep.steps; ++k) {
    for (int i = 0; i < kState; ++i) {
      direction_.state_gradient[k][i] = sweep.state_weight[i] * error[k][i];
    }
    if (!sweep.step[k].contact) continue;
    for (int i = 0; i < kInputs; ++i) {
      direction_.input_gradient[k][i] = input_weight[i] * (input[k][i] - reference[k][i]);
    }
    subtract_transposed(bound, aim_[k], direction_.input_gradient[k]);
  }
  solve(sweep, direction_);
  for (int k = 0; k < sweep.steps; ++k) {
    if (!sweep.step[k].contact) continue;
    rows_of(bound, active[k], direction_.input[k], slack_change_[k]);
    for (int i = 0; i < kRows; ++i) {
      multiplier_change_[k][i] =
          aim_[k][i] - active[k][i] * multiplier[k][i] - weight_[k][i] * slack_change_[k][i];
    }
  }
}

/// Mehrotra's predictor: how far would a step to complementarity 0 get?
/// @return Complementarity that the corrector is to aim at, summed over all rows.
double InteriorPoint::predict(double complementarity) noexcept {
  for (int k = 0; k < sweep.steps; ++k) std::fill_n(aim_[k], kRows, 0.0);
  solve_direction();
  const double length = std::min(1.0, longest_step());
  double products[kRows] = {};
  for (int k = 0; k < sweep.steps; ++k) {
    if (!sweep.step[k].contact) continue;
    for (int i = 0; i < kRows; ++i) {
      products[i] += active[k][i] * (slack[k][i] + length * slack_change_[k][i]) *
                     (multiplier[k][i] + length * multiplier_change_[k][i]);
    }
  }
  double reached = 0.0;
  for (const double product : products) reached += product;
  const double ratio = reached / complementarity;
  return ratio * ratio * ratio * complementarity;
}

/// Sets `aim_` with Mehrotra's second-order correction from the predictor.
void InteriorPoint::aim(double complementarity_per_row) noexcept {
  for (int k = 0; k < sweep.steps; ++k) {
    if (!sweep.step[k].contact) continue;
    for (int i = 0; i < kRows; ++i) {
      aim_[k][i] = active[k][i] * slack_inverse_[k][i] *
                   (complementarity_per_row - slack_change_[k][i] * multiplier_change_[k][i]);
    }
  }
}

/// Length at which the first slack or multiplier would vanish; may be infinite. NaN if any change
/// is not finite.
double InteriorPoint::longest_step() const noexcept {
  double fastest[kRows] = {};
  double sum[kRows] = {};  // keeps what a comparison would drop
  for (int k = 0; k < sweep.steps; ++k) {
    if (!sweep.step[k].contact) continue;
    for (int i = 0; i < kRows; ++i) {
      const double slack_rate = -slack_change_[k][i] * slack_inverse_[k][i];
      const double multiplier_rate = -multiplier_change_[k][i] * multiplier_inverse_[k][i];
      const double rate = slack_rate > multiplier_rate ? slack_rate : multiplier_rate;
      fastest[i] = rate > fastest[i] ? rate : fastest[i];
      sum[i] += slack_rate + multiplier_rate;
    }
  }
  for (const double s : sum) {
    if (!std::isfinite(s)) return std::numeric_limits<double>::quiet_NaN();
  }
  return 1.0 / *std::max_element(fastest, fastest + kRows);
}

void InteriorPoint::take(double length) noexcept {
  for (int k = 0; k < sweep.steps; ++k) {
    for (int i = 0; i < kState; ++i) error[k][i] += length * direction_.state[k][i];
    if (!sweep.step[k].contact) continue;
    for (int i = 0; i < kInputs; ++i) input[k][i] += length * direction_.input[k][i];
    for (int i = 0; i < kRows; ++i) {
      slack[k][i] += length * slack_change_[k][i];
      multiplier[k][i] += length * multiplier_change_[k][i];
    }
  }
}

double InteriorPoint::advance_iterate(double complementarity) noexcept {
  eliminate_rows();
  factorise(sweep);
  double rows = 0.0;
  for (int k = 0; k < sweep.steps; ++k) {
    for (const double a : active[k]) rows += a;
  }
  aim(predict(complementarity) / rows);
  solve_direction();
  const double limit = kToBoundary * longest_step();
  if (std::isnan(limit)) return limit;
  const double length = std::min(1.0, limit);
  take(length);
  return length;
}

}  // namespace hopscotch::control::riccati
