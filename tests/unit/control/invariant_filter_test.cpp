#include "control/invariant_filter.hpp"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <random>

#include "model/gravity.hpp"
#include "model/kinematics.hpp"
#include "tests/unit/control/estimator_fixture.hpp"

namespace hopscotch::control {
namespace {

using core::Leg;
using Eigen::Vector3d;

constexpr double kTick = 0.001;

/// A trunk that swings over two soles and, in between, flies without them, with a sensor whose
/// errors are exactly those that the filter believes in.
class SwingingTrunk {
 public:
  SwingingTrunk(const FilterConfig& config, unsigned seed) : config_(config), rng_(seed) {
    truth_.R_WB = model::rotation_from_rpy(
        {draw(config.start_tilt_sigma), draw(config.start_tilt_sigma), 0.0});
    truth_.v_WB = noise(config.start_speed_sigma);
    truth_.p_WB = {0.3, -0.2, 0.5};
    truth_.p_WF = {Vector3d(0.3, -0.1, 0.0), Vector3d(0.3, -0.3, 0.0)};
    gyro_bias_ = noise(config.gyro_bias_sigma);
    force_bias_ = noise(config.accelerometer_bias_sigma);
  }

  [[nodiscard]] FilterState first_guess() const {
    FilterState guess;
    guess.p_WB = truth_.p_WB;
    return guess;
  }
  [[nodiscard]] const FilterState& truth() const { return truth_; }
  [[nodiscard]] const Vector3d& gyro_bias() const { return gyro_bias_; }

  /// @param pull Ahead, beside the swinging [m/s^2].
  void step(double time, InvariantFilter& filter, double pull = 0.0) {
    const Vector3d rate(2.0 * std::sin(9.0 * time), 3.0 * std::cos(7.0 * time),
                        std::sin(4.0 * time));
    const Vector3d push(3.0 * std::cos(5.0 * time) + pull, 2.0 * std::sin(6.0 * time),
                        4.0 * std::sin(8.0 * time));
    const Vector3d turn = kTick * rate;
    truth_.R_WB = truth_.R_WB * Eigen::AngleAxisd(turn.norm(), turn.normalized());
    truth_.v_WB += kTick * push;
    truth_.p_WB += kTick * truth_.v_WB;
    const Vector3d force = truth_.R_WB.transpose() * (push + Vector3d(0.0, 0.0, model::kGravity));
    gyro_bias_ += noise(config_.gyro_walk * std::sqrt(kTick));
    force_bias_ += noise(config_.accelerometer_walk * std::sqrt(kTick));
    const double per_root = 1.0 / std::sqrt(kTick);
    filter.propagate(rate + gyro_bias_ + noise(config_.gyro_density * per_root),
                     force + force_bias_ + noise(config_.accelerometer_density * per_root), kTick,
                     {config_.foot_density, config_.foot_density});
  }

  void stand(InvariantFilter& filter) {
    for (const Leg leg : core::kAllLegs) {
      Vector3d& p_WF = truth_.p_WF[core::index(leg)];
      if (filter.stands(leg)) {
        p_WF += noise(config_.foot_density * std::sqrt(kTick));
        EXPECT_EQ(filter.correct_foot(leg, seen(leg)), FootVerdict::fits);
      } else {
        p_WF = truth_.p_WB - Vector3d(0.0, 0.0, 0.5);
        filter.add_foot(leg, seen(leg));
      }
    }
  }

  SeenFoot seen(Leg leg) {
    const Vector3d p_BF = truth_.R_WB.transpose() * (truth_.p_WF[core::index(leg)] - truth_.p_WB);
    constexpr double kSigma = 2e-4;
    return {p_BF + noise(std::hypot(kSigma, config_.foot_sigma)),
            kSigma * kSigma * Eigen::Matrix3d::Identity()};
  }

  Vector3d noise(double sigma) { return {draw(sigma), draw(sigma), draw(sigma)}; }

 private:
  double draw(double sigma) { return std::normal_distribution<double>(0.0, sigma)(rng_); }

  FilterConfig config_;
  std::mt19937 rng_;
  FilterState truth_;
  Vector3d gyro_bias_;
  Vector3d force_bias_;
};

/// Attitude, velocity and position error as the filter defines it.
Eigen::Vector<double, 9> error_of(const FilterState& estimate, const FilterState& truth) {
  const Eigen::Matrix3d turn = estimate.R_WB * truth.R_WB.transpose();
  const Eigen::AngleAxisd axis(turn);
  Eigen::Vector<double, 9> error;
  error << axis.angle() * axis.axis(), estimate.v_WB - turn * truth.v_WB,
      estimate.p_WB - turn * truth.p_WB;
  return error;
}

bool flies(int tick) {
  return tick >= 700 && tick < 1000;
}

void run(SwingingTrunk& trunk, InvariantFilter& filter, int ticks) {
  for (int tick = 0; tick < ticks; ++tick) {
    trunk.step(kTick * tick, filter);
    if (flies(tick)) {
      for (const Leg leg : core::kAllLegs) filter.remove_foot(leg);
    } else {
      trunk.stand(filter);
    }
  }
}

TEST(InvariantFilter, ItsCovarianceIsHonest) {
  const FilterConfig config = testing::estimator_config().filter;
  constexpr int kRuns = 60;
  for (const int ticks : {600, 990, 1500}) {  // standing, at the end of a flight, standing again
    double sum = 0.0;
    for (unsigned seed = 1; seed <= kRuns; ++seed) {
      SwingingTrunk trunk(config, seed);
      InvariantFilter filter(config, trunk.first_guess());
      run(trunk, filter, ticks);
      const Eigen::Vector<double, 9> error = error_of(filter.state(), trunk.truth());
      const Eigen::Matrix<double, 9, 9> P = filter.covariance().topLeftCorner<9, 9>();
      sum += error.dot(P.ldlt().solve(error));
    }
    // Mean of 60 chi-squared variables of nine degrees: 9 +- 0.55; four sigmas.
    EXPECT_NEAR(sum / kRuns, 9.0, 2.2) << "after " << ticks << " ms";
  }
}

TEST(InvariantFilter, FindsTiltSpeedAndGyroBias) {
  const FilterConfig config = testing::estimator_config().filter;
  SwingingTrunk trunk(config, 5);
  InvariantFilter filter(config, trunk.first_guess());
  run(trunk, filter, 690);
  const Eigen::Vector<double, 9> error = error_of(filter.state(), trunk.truth());
  EXPECT_LT(error.head<2>().norm(), 0.01);
  EXPECT_LT(error.segment<3>(3).norm(), 0.02);
  EXPECT_LT((filter.state().gyro_bias - trunk.gyro_bias()).head<2>().norm(), 0.003);
}

TEST(InvariantFilter, AFlightCostsMillimetres) {
  const FilterConfig config = testing::estimator_config().filter;
  SwingingTrunk trunk(config, 8);
  InvariantFilter filter(config, trunk.first_guess());
  run(trunk, filter, 700);
  const Vector3d before = filter.state().p_WB - trunk.truth().p_WB;
  for (int tick = 700; tick < 1000; ++tick) {
    trunk.step(kTick * tick, filter);
    for (const Leg leg : core::kAllLegs) filter.remove_foot(leg);
  }
  const Vector3d after = filter.state().p_WB - trunk.truth().p_WB;
  EXPECT_LT((after - before).norm(), 0.01);
}

TEST(InvariantFilter, AHeadingFoundLateMovesNoPlaceFarOff) {
  constexpr double kPull = 60.0;  // for a second, and back: 60 m of flight [m/s^2]
  FilterConfig config = testing::estimator_config().filter;
  config.gyro_bias_sigma = 0.05;
  SwingingTrunk trunk(config, 8);
  InvariantFilter filter(config, trunk.first_guess());
  for (int tick = 0; tick < 2000; ++tick) {
    trunk.step(kTick * tick, filter, tick < 1000 ? kPull : -kPull);
  }
  ASSERT_GT(trunk.truth().p_WB.x(), 50.0);
  const auto place_error = [&] { return filter.state().p_WB - trunk.truth().p_WB; };
  const auto heading_error = [&] {
    return error_of(filter.state(), trunk.truth())(InvariantFilter::kAttitude + 2);
  };
  trunk.stand(filter);
  const Vector3d place = place_error();
  const double heading = heading_error();
  for (int tick = 2000; tick < 3500; ++tick) {
    trunk.step(kTick * tick, filter);
    trunk.stand(filter);
  }
  // The gyroscope's bias shows while the trunk swings, and with it what it did to the heading.
  EXPECT_LT(std::abs(heading_error()), std::abs(heading) - 0.01);
  EXPECT_LT((place_error() - place).norm(), 0.05);
}

TEST(InvariantFilter, ASlippedFootIsTakenAnew) {
  const FilterConfig config = testing::estimator_config().filter;
  SwingingTrunk trunk(config, 3);
  InvariantFilter filter(config, trunk.first_guess());
  run(trunk, filter, 300);
  const Vector3d v = filter.state().v_WB;
  SeenFoot slipped = trunk.seen(Leg::left);
  slipped.p_BF.x() += 0.05;
  EXPECT_EQ(filter.correct_foot(Leg::left, slipped), FootVerdict::slipped);
  EXPECT_EQ(filter.state().v_WB, v);
  EXPECT_EQ(filter.correct_foot(Leg::left, slipped), FootVerdict::fits);
}

TEST(InvariantFilter, AMapHeightIsBelievedWithinItsGate) {
  const FilterConfig config = testing::estimator_config().filter;
  SwingingTrunk trunk(config, 4);
  InvariantFilter filter(config, trunk.first_guess());
  run(trunk, filter, 1200);
  const double height = filter.state().p_WF[0].z();
  EXPECT_FALSE(filter.correct_height(Leg::left, height + 0.10));
  EXPECT_EQ(filter.state().p_WF[0].z(), height);
  const double p = filter.state().p_WB.z();
  EXPECT_TRUE(filter.correct_height(Leg::left, height + 0.004));
  EXPECT_GT(filter.state().p_WF[0].z(), height);
  EXPECT_GT(filter.state().p_WB.z(), p);  // the trunk rises with the ground that it stands on
}

TEST(InvariantFilter, AfterADoubtedFlightASingleWrongMapHeightIsStillRefused) {
  const FilterConfig config = testing::estimator_config().filter;
  SwingingTrunk trunk(config, 4);
  InvariantFilter filter(config, trunk.first_guess());
  run(trunk, filter, 1050);
  ASSERT_TRUE(filter.stands(Leg::left));
  filter.doubt_flight({.rise_speed = 0.2, .flown = 0.3, .stood = 0.05});
  EXPECT_GT(filter.covariance()(InvariantFilter::kPosition + 2, InvariantFilter::kPosition + 2),
            0.03 * 0.03);
  for (int tick = 1050; tick < 1150; ++tick) {
    trunk.step(kTick * tick, filter);
    trunk.stand(filter);
  }
  const double height = filter.state().p_WF[0].z();
  EXPECT_NEAR(filter.state().p_WB.z(), trunk.truth().p_WB.z(), 0.01);
  EXPECT_FALSE(filter.correct_height(Leg::left, height + 0.05));
  EXPECT_EQ(filter.state().p_WF[0].z(), height);
  EXPECT_GT(filter.covariance().selfadjointView<Eigen::Lower>().eigenvalues().minCoeff(), -1e-12);
}

TEST(InvariantFilter, CovarianceStaysSymmetricAndPositive) {
  const FilterConfig config = testing::estimator_config().filter;
  SwingingTrunk trunk(config, 6);
  InvariantFilter filter(config, trunk.first_guess());
  run(trunk, filter, 5000);
  const InvariantFilter::Covariance& P = filter.covariance();
  EXPECT_LT((P - P.transpose()).norm(), 1e-12 * P.norm());
  EXPECT_GT(P.selfadjointView<Eigen::Lower>().eigenvalues().minCoeff(), -1e-12);
}

}  // namespace
}  // namespace hopscotch::control
