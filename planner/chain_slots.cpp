#include "planner/chain_slots.hpp"

#include <algorithm>
#include <cmath>

namespace hopscotch::planner {

namespace {

/// Multipliers stay within this factor of barrier / gap, as safeguard of the Newton steps.
constexpr double kMultiplierSpread = 1e10;

double ratio_limit(double value, double step, double keep) {
  return step < 0.0 ? -keep * value / step : 1.0;
}

}  // namespace

ChainSlots::ChainSlots(int slots) {
  for (Eigen::VectorXd* each : {&lower_, &upper_, &has_lower_, &has_upper_, &slack_, &at_lower_,
                                &at_upper_, &lower_step_, &upper_step_, &multiplier_, &weight_}) {
    each->setZero(slots);
  }
}

void ChainSlots::set_bounds(const Eigen::VectorXd& lower, const Eigen::VectorXd& upper) {
  sides_ = 0.0;
  for (Eigen::Index i = 0; i < lower.size(); ++i) {
    has_lower_(i) = std::isfinite(lower(i)) ? 1.0 : 0.0;
    has_upper_(i) = std::isfinite(upper(i)) ? 1.0 : 0.0;
    lower_(i) = has_lower_(i) > 0.0 ? lower(i) : 0.0;
    upper_(i) = has_upper_(i) > 0.0 ? upper(i) : 0.0;
    sides_ += has_lower_(i) + has_upper_(i);
  }
}

double ChainSlots::inside(int i, double v, double push) const {
  const bool both = has_lower_(i) > 0.0 && has_upper_(i) > 0.0;
  const double range = both ? push * (upper_(i) - lower_(i)) : push;
  const double from_lower = std::min(push * std::max(1.0, std::abs(lower_(i))), range);
  const double from_upper = std::min(push * std::max(1.0, std::abs(upper_(i))), range);
  if (has_lower_(i) > 0.0) v = std::max(v, lower_(i) + from_lower);
  if (has_upper_(i) > 0.0) v = std::min(v, upper_(i) - from_upper);
  return v;
}

void ChainSlots::start(const Eigen::VectorXd& values, double push, double barrier) {
  at_lower_.setZero();
  at_upper_.setZero();
  restart(values, push, barrier, 1.0);
}

void ChainSlots::restart(const Eigen::VectorXd& values, double push, double barrier,
                         double spread) {
  for (int i = 0; i < static_cast<int>(slack_.size()); ++i) {
    slack_(i) = inside(i, values(i), push);
    if (has_lower_(i) > 0.0) {
      const double centre = barrier / (slack_(i) - lower_(i));
      at_lower_(i) = std::clamp(at_lower_(i), centre / spread, centre * spread);
    }
    if (has_upper_(i) > 0.0) {
      const double centre = barrier / (upper_(i) - slack_(i));
      at_upper_(i) = std::clamp(at_upper_(i), centre / spread, centre * spread);
    }
  }
  update_weights();
}

void ChainSlots::recall(const Eigen::VectorXd& multiplier) {
  at_lower_ = (-multiplier).cwiseMax(0.0);
  at_upper_ = multiplier.cwiseMax(0.0);
}

void ChainSlots::update_weights() {
  for (Eigen::Index i = 0; i < slack_.size(); ++i) {
    multiplier_(i) = at_upper_(i) - at_lower_(i);
    const double below = has_lower_(i) > 0.0 ? slack_(i) - lower_(i) : 1.0;
    const double above = has_upper_(i) > 0.0 ? upper_(i) - slack_(i) : 1.0;
    weight_(i) = at_lower_(i) / below + at_upper_(i) / above;
  }
}

void ChainSlots::slopes(double barrier, const Eigen::VectorXd& residual,
                        Eigen::VectorXd& out) const {
  for (Eigen::Index i = 0; i < slack_.size(); ++i) {
    const double below = has_lower_(i) > 0.0 ? slack_(i) - lower_(i) : 1.0;
    const double above = has_upper_(i) > 0.0 ? upper_(i) - slack_(i) : 1.0;
    out(i) = barrier * (has_upper_(i) / above - has_lower_(i) / below) + weight_(i) * residual(i);
  }
}

double ChainSlots::complementarity(double barrier) const {
  double worst = 0.0;
  for (Eigen::Index i = 0; i < slack_.size(); ++i) {
    const double below = has_lower_(i) * ((slack_(i) - lower_(i)) * at_lower_(i) - barrier);
    const double above = has_upper_(i) * ((upper_(i) - slack_(i)) * at_upper_(i) - barrier);
    worst = std::max({worst, std::abs(below), std::abs(above)});
  }
  return worst;
}

double ChainSlots::mean_product() const {
  double sum = 0.0;
  for (Eigen::Index i = 0; i < slack_.size(); ++i) {
    sum += (slack_(i) - lower_(i)) * at_lower_(i) + (upper_(i) - slack_(i)) * at_upper_(i);
  }
  return sum / std::max(1.0, sides_);
}

double ChainSlots::multiplier_sum() const {
  return at_lower_.sum() + at_upper_.sum();
}

double ChainSlots::barrier_value(double step, const Eigen::VectorXd& change) const {
  // Logarithms of products: one for many gaps. Gaps are between 1e-12 and 1e2.
  constexpr Eigen::Index kGroup = 8;
  double sum = 0.0;
  double product = 1.0;
  for (Eigen::Index i = 0; i < slack_.size(); ++i) {
    const double s = slack_(i) + step * change(i);
    const double below = has_lower_(i) > 0.0 ? s - lower_(i) : 1.0;
    const double above = has_upper_(i) > 0.0 ? upper_(i) - s : 1.0;
    product *= below * above;
    if (i % kGroup == kGroup - 1) {
      sum -= std::log(product);
      product = 1.0;
    }
  }
  return sum - std::log(product);
}

double ChainSlots::barrier_slope(const Eigen::VectorXd& change) const {
  double sum = 0.0;
  for (Eigen::Index i = 0; i < slack_.size(); ++i) {
    const double below = has_lower_(i) > 0.0 ? slack_(i) - lower_(i) : 1.0;
    const double above = has_upper_(i) > 0.0 ? upper_(i) - slack_(i) : 1.0;
    sum += change(i) * (has_upper_(i) / above - has_lower_(i) / below);
  }
  return sum;
}

StepLimits ChainSlots::find_step(const Eigen::VectorXd& change, double barrier, double keep) {
  StepLimits limits;
  for (Eigen::Index i = 0; i < slack_.size(); ++i) {
    lower_step_(i) = upper_step_(i) = 0.0;
    if (has_lower_(i) > 0.0) {
      const double gap = slack_(i) - lower_(i);
      lower_step_(i) = (barrier - at_lower_(i) * change(i)) / gap - at_lower_(i);
      limits.primal = std::min(limits.primal, ratio_limit(gap, change(i), keep));
      limits.dual = std::min(limits.dual, ratio_limit(at_lower_(i), lower_step_(i), keep));
    }
    if (has_upper_(i) > 0.0) {
      const double gap = upper_(i) - slack_(i);
      upper_step_(i) = (barrier + at_upper_(i) * change(i)) / gap - at_upper_(i);
      limits.primal = std::min(limits.primal, ratio_limit(gap, -change(i), keep));
      limits.dual = std::min(limits.dual, ratio_limit(at_upper_(i), upper_step_(i), keep));
    }
  }
  return limits;
}

void ChainSlots::move(double primal, double dual, const Eigen::VectorXd& change, double barrier) {
  for (Eigen::Index i = 0; i < slack_.size(); ++i) {
    slack_(i) += primal * change(i);
    at_lower_(i) += dual * lower_step_(i);
    at_upper_(i) += dual * upper_step_(i);
    if (has_lower_(i) > 0.0) {
      const double centre = barrier / (slack_(i) - lower_(i));
      at_lower_(i) =
          std::clamp(at_lower_(i), centre / kMultiplierSpread, centre * kMultiplierSpread);
    }
    if (has_upper_(i) > 0.0) {
      const double centre = barrier / (upper_(i) - slack_(i));
      at_upper_(i) =
          std::clamp(at_upper_(i), centre / kMultiplierSpread, centre * kMultiplierSpread);
    }
  }
  update_weights();
}

}  // namespace hopscotch::planner
