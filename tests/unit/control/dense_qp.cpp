#include "tests/unit/control/dense_qp.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace hopscotch::control::testing {

namespace {

using State = Eigen::Matrix<Real, 12, 1>;
using Transition = Eigen::Matrix<Real, 12, 12>;
using FootColumns = Eigen::Matrix<Real, 12, 5>;

/// T of p and rpy together.
Eigen::Matrix<Real, 6, 6> configuration_rate(const WrenchQpStage& stage) {
  Eigen::Matrix<Real, 6, 6> rate = Eigen::Matrix<Real, 6, 6>::Identity();
  rate.bottomRightCorner<3, 3>() = stage.rpy_rate.cast<Real>();
  return rate;
}

Transition transition(const WrenchQpStage& stage) {
  Transition A = Transition::Identity();
  A.topRightCorner<6, 6>() = static_cast<Real>(stage.dt) * configuration_rate(stage);
  return A;
}

/// State change by an increment of the velocities over the step.
template <typename Increment>
Eigen::Matrix<Real, 12, Increment::ColsAtCompileTime> by_increment(const WrenchQp& qp,
                                                                   const WrenchQpStage& stage,
                                                                   const Increment& increment) {
  const Real half = qp.rule == StepRule::zero_order_hold ? 0.5L * static_cast<Real>(stage.dt) : 0;
  Eigen::Matrix<Real, 12, Increment::ColsAtCompileTime> out;
  out << half * (configuration_rate(stage) * increment), increment;
  return out;
}

FootColumns columns(const WrenchQp& qp, const WrenchQpStage& stage, const WrenchQpFoot& foot) {
  // Wrench on the body from [Fx Fy My Mz Fz].
  Eigen::Matrix<Real, 3, 5> force = Eigen::Matrix<Real, 3, 5>::Zero();
  force(0, 0) = force(1, 1) = force(2, 4) = 1;
  force = (foot.R_force.cast<Real>() * force).eval();
  Eigen::Matrix<Real, 3, 5> moment = Eigen::Matrix<Real, 3, 5>::Zero();
  moment(1, 2) = moment(2, 3) = 1;
  moment = (foot.R_moment.cast<Real>() * moment).eval();
  const Eigen::Matrix<Real, 3, 1> r = foot.p_GF.cast<Real>();
  for (int i = 0; i < 5; ++i) {
    moment.col(i) += r.cross(Eigen::Matrix<Real, 3, 1>(force.col(i)));
  }
  Eigen::Matrix<Real, 6, 5> increment;
  increment << static_cast<Real>(stage.dt) / static_cast<Real>(qp.mass) * force,
      static_cast<Real>(stage.dt) * (stage.inertia_inverse.cast<Real>() * moment);
  return by_increment(qp, stage, increment);
}

void find_feet(const WrenchQp& qp, DenseQp& out) {
  Eigen::Index first = 0;
  for (int k = 0; k < qp.horizon; ++k) {
    for (const core::Leg leg : core::kAllLegs) {
      if (!qp.stages[static_cast<std::size_t>(k)].feet[core::index(leg)].contact) continue;
      out.feet.push_back({k, leg, first});
      first += 5;
    }
  }
}

void roll_out(const WrenchQp& qp, DenseQp& out) {
  const Eigen::Index n = 5 * static_cast<Eigen::Index>(out.feet.size());
  out.gain = DenseMatrix::Zero(12 * qp.horizon, n);
  out.free = DenseVector::Zero(12 * qp.horizon);
  State x = qp.x0.cast<Real>();
  DenseMatrix G = DenseMatrix::Zero(12, n);
  for (int k = 0; k < qp.horizon; ++k) {
    const WrenchQpStage& stage = qp.stages[static_cast<std::size_t>(k)];
    const Transition A = transition(stage);
    const Eigen::Matrix<Real, 6, 1> own = stage.velocity_gain.cast<Real>();
    x = (A * x + by_increment(qp, stage, own)).eval();
    G = (A * G).eval();
    for (const DenseFoot& foot : out.feet) {
      if (foot.step != k) continue;
      G.middleCols(foot.first, 5) += columns(qp, stage, stage.feet[core::index(foot.leg)]);
    }
    out.free.segment(12 * k, 12) = x;
    out.gain.middleRows(12 * k, 12) = G;
  }
}

void add_costs(const WrenchQp& qp, DenseQp& out) {
  const Eigen::Index n = out.gain.cols();
  out.H = DenseMatrix::Zero(n, n);
  out.g = DenseVector::Zero(n);
  const State weight = 2.0L * qp.state_weight.cast<Real>();
  for (int k = 0; k < qp.horizon; ++k) {
    const State error =
        out.free.segment(12 * k, 12) - qp.stages[static_cast<std::size_t>(k)].target.cast<Real>();
    const DenseMatrix G = out.gain.middleRows(12 * k, 12);
    out.H += G.transpose() * weight.asDiagonal() * G;
    out.g += G.transpose() * (weight.asDiagonal() * error);
    out.constant += 0.5L * error.dot(weight.asDiagonal() * error);
  }
  for (const DenseFoot& foot : out.feet) {
    const Eigen::Matrix<Real, 5, 1> reference = qp.stages[static_cast<std::size_t>(foot.step)]
                                                    .feet[core::index(foot.leg)]
                                                    .reference.cast<Real>();
    const Eigen::Matrix<Real, 5, 1> r = 2.0L * qp.input_weight.cast<Real>();
    out.H.diagonal().segment(foot.first, 5) += r;
    out.g.segment(foot.first, 5) -= r.cwiseProduct(reference);
    out.constant += 0.5L * reference.dot(r.asDiagonal() * reference);
  }
}

/// Nine rows per foot: the upper sides, the lower sides, the top. Free sides say 1 >= 0.
void add_rows(const WrenchQp& qp, DenseQp& out) {
  const Eigen::Index feet = static_cast<Eigen::Index>(out.feet.size());
  out.A = DenseMatrix::Zero(9 * feet, 5 * feet);
  out.b = DenseVector::Zero(9 * feet);
  for (Eigen::Index f = 0; f < feet; ++f) {
    for (Eigen::Index i = 0; i < 4; ++i) {
      for (const int side : {0, 1}) {
        const Eigen::Index row = 9 * f + 4 * side + i;
        const double bound = side == 0 ? qp.cone.upper(i) : qp.cone.lower(i);
        if (!std::isfinite(bound)) {
          out.b(row) = 1;
          continue;
        }
        out.A(row, 5 * f + 4) = bound;
        out.A(row, 5 * f + i) = side == 0 ? -1 : 1;
      }
    }
    out.A(9 * f + 8, 5 * f + 4) = -1;
    out.b(9 * f + 8) = qp.cone.max_normal_force;
  }
}

/// Longest step in (0, 1] that keeps all of `value` + step * `change` positive, a little shortened.
Real step_length(const DenseVector& value, const DenseVector& change) {
  Real length = 1;
  for (Eigen::Index i = 0; i < value.size(); ++i) {
    if (change(i) < 0) length = std::min(length, -0.995L * value(i) / change(i));
  }
  return length;
}

}  // namespace

Real DenseQp::objective(const DenseVector& z) const {
  const DenseVector slope = 0.5L * (H * z) + g;
  Real sum = constant;
  for (Eigen::Index i = 0; i < z.size(); ++i) sum += z(i) * slope(i);
  return sum;
}

DenseQp condense(const WrenchQp& qp) {
  DenseQp out;
  find_feet(qp, out);
  roll_out(qp, out);
  add_costs(qp, out);
  add_rows(qp, out);
  return out;
}

DenseVector solve_dense(const DenseQp& qp) {
  const Eigen::Index n = qp.g.size();
  const Eigen::Index m = qp.b.size();
  DenseVector z = DenseVector::Zero(n);
  DenseVector s = DenseVector::Constant(m, 10);
  DenseVector lambda = DenseVector::Constant(m, 1e-2L);
  for (int iteration = 0; iteration < 60; ++iteration) {
    const DenseVector dual = qp.H * z + qp.g - qp.A.transpose() * lambda;
    const DenseVector primal = qp.A * z + qp.b - s;
    const Real mu = s.dot(lambda) / static_cast<Real>(m);
    const Real gradient = 1.0L + qp.g.cwiseAbs().maxCoeff();
    if (mu < 1e-14L && dual.cwiseAbs().maxCoeff() < 1e-12L * gradient &&
        primal.cwiseAbs().maxCoeff() < 1e-10L) {
      break;
    }
    const DenseVector d = lambda.cwiseQuotient(s);
    DenseMatrix newton = qp.H;
    for (const DenseFoot& foot : qp.feet) {  // the rows of a foot touch its own inputs only
      const DenseMatrix rows = qp.A.block(foot.first / 5 * 9, foot.first, 9, 5);
      newton.block(foot.first, foot.first, 5, 5) +=
          rows.transpose() * d.segment(foot.first / 5 * 9, 9).asDiagonal() * rows;
    }
    const Eigen::LLT<DenseMatrix> factor(newton);
    const auto direction = [&](const DenseVector& aim, DenseVector& ds, DenseVector& dl) {
      // s dl + lambda ds = aim,  A dz - ds = -primal,  H dz - A' dl = -dual
      const DenseVector rhs =
          -dual + qp.A.transpose() * (aim - lambda.cwiseProduct(primal)).cwiseQuotient(s);
      DenseVector dz = factor.solve(rhs);
      ds = qp.A * dz + primal;
      dl = (aim - lambda.cwiseProduct(ds)).cwiseQuotient(s);
      return dz;
    };
    DenseVector ds;
    DenseVector dl;
    direction(-s.cwiseProduct(lambda), ds, dl);
    const Real reach = std::min(step_length(s, ds), step_length(lambda, dl));
    const Real left = (s + reach * ds).dot(lambda + reach * dl) / static_cast<Real>(m);
    const Real centre = mu * std::pow(left / mu, 3.0L);
    const DenseVector aim =
        (DenseVector::Constant(m, centre) - s.cwiseProduct(lambda) - ds.cwiseProduct(dl));
    const DenseVector dz = direction(aim, ds, dl);
    const Real length = std::min(step_length(s, ds), step_length(lambda, dl));
    z += length * dz;
    s += length * ds;
    lambda += length * dl;
  }
  return z;
}

KktResiduals kkt_residuals(const DenseQp& qp, const DenseVector& z, const DenseVector& lambda) {
  const DenseVector slack = qp.A * z + qp.b;
  const DenseVector gradient = qp.H * z + qp.g - qp.A.transpose() * lambda;
  KktResiduals result;
  result.stationarity = static_cast<double>(gradient.cwiseAbs().maxCoeff());
  result.primal = static_cast<double>(std::max<Real>(0, -slack.minCoeff()));
  result.dual = static_cast<double>(std::max<Real>(0, -lambda.minCoeff()));
  result.complementarity = static_cast<double>(slack.cwiseProduct(lambda).cwiseAbs().sum());
  return result;
}

}  // namespace hopscotch::control::testing
