#include "control/qp_solver_riccati.hpp"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <memory>
#include <random>

namespace hopscotch::control::riccati {
namespace {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;
using StateVector = Eigen::Vector<double, kState>;

constexpr int kSteps = 5;

/// A random sweep whose dynamics and Hessians are also there as plain matrices.
class RiccatiTest : public ::testing::Test {
 protected:
  void SetUp() override {
    sweep_->steps = kSteps;
    for (int i = 0; i < kState; ++i) sweep_->state_weight[i] = 1.0 + std::abs(number());
    for (int k = 0; k < kSteps; ++k) {
      fill_drift(0.02 + 0.01 * k, sweep_->step[k].before);
      fill_drift(k % 2 == 0 ? 0.0 : 0.02, sweep_->step[k].after);
      fill_columns(k, k != 2);  // no contact in step 2
      fill_elimination(k, sweep_->step[k].contact);
    }
  }

  double number() { return uniform_(rng_); }

  void fill_drift(double time, Drift& drift) {
    drift.time = time;
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) {
        drift.rate[j][i] = drift.padded[i][3 + j] = time * ((i == j ? 1.0 : 0.0) + 0.3 * number());
      }
    }
  }

  void fill_columns(int k, bool contact) {
    Step& step = sweep_->step[k];
    step.contact = contact;
    for (int i = 0; i < kInputs; ++i) {
      const bool moment = i < kLanes && i % 4 >= 2;
      for (int j = 0; j < kWrench; ++j) {
        const double value = contact && !(moment && j < 3) ? number() : 0.0;
        step.rows[j][i] = step.columns[i][j] = value;
      }
    }
  }

  /// W per foot from random positive weights: diagonal of the lanes, arrow, normal.
  void fill_elimination(int k, bool contact) {
    Matrix& W = W_[static_cast<std::size_t>(k)];
    W = Matrix::Identity(kInputs, kInputs);
    if (!contact) return;
    Elimination& e = sweep_->elimination[k];
    for (int foot = 0; foot < 2; ++foot) {
      const int normal = kLanes + foot;
      double schur = 0.5 + std::abs(number());
      W(normal, normal) = schur;
      for (int lane = 4 * foot; lane < 4 * foot + 4; ++lane) {
        W(lane, lane) = 0.1 + std::abs(number());
        W(lane, normal) = W(normal, lane) = number();
        W(normal, normal) += W(lane, normal) * W(lane, normal) / W(lane, lane);
        e.inverse[lane] = 1.0 / W(lane, lane);
        e.arrow[lane] = W(lane, normal) / W(lane, lane);
      }
      e.inverse[normal] = 1.0 / schur;
    }
  }

  static StateVector advanced(const Step& step, const Vector& kick, const StateVector& x) {
    alignas(16) double state[kState];
    alignas(16) double gain[kWrench];
    std::copy(x.begin(), x.end(), state);
    std::copy(kick.begin(), kick.end(), gain);
    advance(step, gain, state);
    return Eigen::Map<StateVector>(state);
  }

  /// States after each step as a linear map of all inputs, column by column.
  Matrix response() {
    Matrix out = Matrix::Zero(kState * kSteps, kInputs * kSteps);
    for (int column = 0; column < out.cols(); ++column) {
      StateVector x = StateVector::Zero();
      for (int k = 0; k < kSteps; ++k) {
        Vector kick = Vector::Zero(kWrench);
        if (column / kInputs == k) {
          kick = Eigen::Map<Vector>(sweep_->step[k].columns[column % kInputs], kWrench);
        }
        x = advanced(sweep_->step[k], kick, x);
        out.block(kState * k, column, kState, 1) = x;
      }
    }
    return out;
  }

  std::mt19937 rng_{12};
  std::uniform_real_distribution<double> uniform_{-1.0, 1.0};
  std::unique_ptr<Sweep> sweep_ = std::make_unique<Sweep>();
  std::unique_ptr<Direction> direction_ = std::make_unique<Direction>();
  std::array<Matrix, kSteps> W_;
};

TEST_F(RiccatiTest, AdvanceIsDriftThenKickThenDrift) {
  const Step& step = sweep_->step[1];
  const StateVector x = StateVector::NullaryExpr([&] { return number(); });
  const Vector kick = Vector::NullaryExpr(kWrench, [&] { return number(); });
  const Eigen::Map<const Eigen::Matrix3d> before(&step.before.rate[0][0]);
  const Eigen::Map<const Eigen::Matrix3d> after(&step.after.rate[0][0]);
  const Vector v = x.head<6>() + kick;
  StateVector expected;
  expected << v, x.segment<3>(6) + step.before.time * x.head<3>() + step.after.time * v.head<3>(),
      x.tail<3>() + before * x.segment<3>(3) + after * v.tail<3>();
  EXPECT_LE((advanced(step, kick, x) - expected).norm(), 1e-15 * expected.norm() * kState);
}

TEST_F(RiccatiTest, DirectionSolvesTheCondensedNewtonSystem) {
  const Matrix G = response();
  Vector g = Vector::NullaryExpr(kInputs * kSteps, [&] { return number(); });
  const Vector q = Vector::NullaryExpr(kState * kSteps, [&] { return number(); });
  Matrix H = Matrix::Zero(g.size(), g.size());
  Vector weight(kState * kSteps);
  for (int k = 0; k < kSteps; ++k) {
    H.block(kInputs * k, kInputs * k, kInputs, kInputs) = W_[static_cast<std::size_t>(k)];
    if (!sweep_->step[k].contact) g.segment(kInputs * k, kInputs).setZero();
    weight.segment(kState * k, kState) = Eigen::Map<Vector>(sweep_->state_weight, kState);
    std::copy_n(g.begin() + kInputs * k, kInputs, direction_->input_gradient[k]);
    std::copy_n(q.begin() + kState * k, kState, direction_->state_gradient[k]);
  }
  H += G.transpose() * weight.asDiagonal() * G;
  const Vector expected = -H.llt().solve(g + G.transpose() * q);

  factorise(*sweep_);
  solve(*sweep_, *direction_);
  const Vector states = G * expected;
  for (int k = 0; k < kSteps; ++k) {
    const Eigen::Map<Vector> input(direction_->input[k], kInputs);
    const Eigen::Map<Vector> state(direction_->state[k], kState);
    // Both factorisations lose the condition number of a small, tame system.
    EXPECT_LE((input - expected.segment(kInputs * k, kInputs)).norm(), 1e-10) << "step " << k;
    EXPECT_LE((state - states.segment(kState * k, kState)).norm(), 1e-10) << "step " << k;
  }
}

TEST_F(RiccatiTest, AdjointIsTheTransposedResponse) {
  const Vector q = Vector::NullaryExpr(kState * kSteps, [&] { return number(); });
  for (int k = 0; k < kSteps; ++k) {
    std::copy_n(q.begin() + kState * k, kState, direction_->state_gradient[k]);
  }
  adjoint(*sweep_, direction_->state_gradient, direction_->input_gradient);
  const Vector expected = response().transpose() * q;
  for (int k = 0; k < kSteps; ++k) {
    const Eigen::Map<Vector> gradient(direction_->input_gradient[k], kInputs);
    EXPECT_LE((gradient - expected.segment(kInputs * k, kInputs)).norm(), 1e-13) << "step " << k;
  }
}

}  // namespace
}  // namespace hopscotch::control::riccati
