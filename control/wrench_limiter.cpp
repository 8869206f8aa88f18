#include "control/wrench_limiter.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

#include "control/torque_law.hpp"
#include "control/wrench_mpc_problem.hpp"
#include "model/kinematics.hpp"
#include "model/motor.hpp"

namespace hopscotch::control {

namespace {

constexpr int kMotorRows = 2 * core::kJointsPerLeg;
constexpr int kConeRows = 9;
constexpr int kRows = kMotorRows + kConeRows;

using LegMap = Eigen::Matrix<double, core::kJointsPerLeg, 5>;
using RowVector = Eigen::Vector<double, kRows>;
using RowMatrix = Eigen::Matrix<double, kRows, kRows>;

/// rows u <= bound; motors first, upper sides before lower ones.
struct Rows {
  Eigen::Matrix<double, kRows, 5> rows = Eigen::Matrix<double, kRows, 5>::Zero();
  RowVector bound = RowVector::Zero();

  [[nodiscard]] RowVector breach(const FootInput& u) const { return rows * u - bound; }
};

/// Motor torques per unit of a FootInput: -M J'.
LegMap motor_columns(const model::RobotParameters& robot, core::Leg leg,
                     const core::RobotState& state, double yaw) {
  const core::LegVector q = state.q.segment<core::kJointsPerLeg>(core::leg_offset(leg));
  const Eigen::Matrix<double, core::kJointsPerLeg, 6> Jt =
      model::sole_jacobian(robot, leg, q).transpose();
  LegMap motors;
  for (int i = 0; i < 5; ++i) {
    const core::Wrench unit = foot_wrench(FootInput::Unit(i), yaw);
    Eigen::Vector<double, 6> unit_B;
    unit_B << state.R_WB.transpose() * unit.force, state.R_WB.transpose() * unit.moment;
    motors.col(i) = model::motor_torques(-Jt * unit_B);
  }
  return motors;
}

void add_motors(const model::RobotParameters& robot, const LegMap& motors,
                const core::LegVector& base, const core::LegVector& dq, Rows& out) {
  const core::LegVector given = model::motor_torques(base);
  const core::LegVector speed = model::motor_speeds(dq);
  for (int i = 0; i < core::kJointsPerLeg; ++i) {
    const model::TorqueBounds bounds =
        model::torque_bounds(robot, static_cast<core::Joint>(i), speed(i));
    out.rows.row(i) = motors.row(i);
    out.rows.row(core::kJointsPerLeg + i) = -motors.row(i);
    out.bound(i) = std::max(0.0, bounds.upper - given(i));
    out.bound(core::kJointsPerLeg + i) = std::max(0.0, given(i) - bounds.lower);
  }
}

/// Eqs. (14b) to (14e).
void add_cone(const WrenchCone& cone, Rows& out) {
  for (int i = 0; i < 4; ++i) {
    const int upper = kMotorRows + i;
    const int lower = kMotorRows + 4 + i;
    if (std::isfinite(cone.upper(i))) {
      out.rows(upper, i) = 1.0;
      out.rows(upper, kForceZ) = -cone.upper(i);
    }
    if (std::isfinite(cone.lower(i))) {
      out.rows(lower, i) = -1.0;
      out.rows(lower, kForceZ) = -cone.lower(i);
    }
  }
  out.rows(kRows - 1, kForceZ) = 1.0;
  out.bound(kRows - 1) = cone.max_normal_force;
}

/// Distance of two wrenches in shares of what each motor can give, as a form in a FootInput.
Eigen::Matrix<double, 5, 5> torque_metric(const model::RobotParameters& robot,
                                          const LegMap& motors) {
  constexpr double kRidge = 1e-9;  // A straight knee bears any load along the leg [1/N^2].
  LegMap shares = motors;
  for (std::size_t i = 0; i < robot.motors.size(); ++i) {
    shares.row(static_cast<Eigen::Index>(i)) /= robot.motors[i].torque_max;
  }
  return shares.transpose() * shares + kRidge * LegMap::Identity();
}

/// Lawson's and Hanson's active set on the dual of a projection: min 1/2 m' reaction m - breach' m
/// over m >= 0. The row that is breached most joins the set of those that push; the ones that would
/// have to pull for it leave.
class PushingRows {
 public:
  /// @param reaction How much of row i's breach row j takes back by pushing; 1 on the diagonal.
  PushingRows(const RowMatrix& reaction, const RowVector& breach)
      : reaction_(reaction), breach_(breach) {}

  RowVector multipliers() {
    constexpr double kBreachMax = 1e-7;
    for (changes_ = 0; changes_ < kChangesMax;) {
      RowVector left = breach_ - reaction_ * multiplier_;
      for (int i = 0; i < count_; ++i) left(set_[static_cast<std::size_t>(i)]) = 0.0;
      Eigen::Index worst = 0;
      if (left.maxCoeff(&worst) <= kBreachMax) break;
      set_[static_cast<std::size_t>(count_++)] = static_cast<int>(worst);
      while (changes_ < kChangesMax && !balance()) {
      }
    }
    return multiplier_;
  }

 private:
  static constexpr int kChangesMax = 30;  ///< Two or three are usual.

  /// Goes towards the multipliers that hold all of the set, until the first would have to pull.
  /// @return true if none does.
  bool balance() {
    ++changes_;
    const SetVector wanted = balanced();
    double share = 1.0;
    for (int i = 0; i < count_; ++i) {
      if (wanted(i) > 0.0) continue;
      const double had = multiplier_(set_[static_cast<std::size_t>(i)]);
      share = std::min(share, had > 0.0 ? had / (had - wanted(i)) : 0.0);
    }
    const int before = count_;
    count_ = 0;
    for (int i = 0; i < before; ++i) {
      const int row = set_[static_cast<std::size_t>(i)];
      const double had = multiplier_(row);
      multiplier_(row) = std::max(0.0, had + share * (wanted(i) - had));
      const bool leaves = wanted(i) <= 0.0 && had - share * (had - wanted(i)) <= 1e-12 * had;
      if (leaves) {
        multiplier_(row) = 0.0;
      } else {
        set_[static_cast<std::size_t>(count_++)] = row;
      }
    }
    return share == 1.0;
  }

  using SetVector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kRows, 1>;
  using SetMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kRows, kRows>;

  /// Multipliers, of either sign, that hold every row of the set. Rows yield by a little of what
  /// they hold back, so that dependent ones may be in the set.
  [[nodiscard]] SetVector balanced() const {
    constexpr double kSoftness = 1e-8;
    const Eigen::Map<const Eigen::VectorXi> rows(set_.data(), count_);
    SetMatrix among = reaction_(rows, rows);
    among.diagonal().array() += kSoftness;
    return among.ldlt().solve(SetVector(breach_(rows)));
  }

  const RowMatrix& reaction_;
  const RowVector& breach_;
  RowVector multiplier_ = RowVector::Zero();
  std::array<int, kRows> set_{};
  int count_ = 0;
  int changes_ = 0;
};

/// min |u - asked|^2_metric s.t. rows.
FootInput nearest(Rows rows, const Eigen::Matrix<double, 5, 5>& metric, const FootInput& asked) {
  const Eigen::LDLT<Eigen::Matrix<double, 5, 5>> factor(metric);
  for (int r = 0; r < kRows; ++r) {
    const FootInput row = rows.rows.row(r).transpose();
    const double yields = row.dot(factor.solve(row));
    if (!(yields > 0.0)) continue;
    rows.rows.row(r) /= std::sqrt(yields);
    rows.bound(r) /= std::sqrt(yields);
  }
  const Eigen::Matrix<double, 5, kRows> push = factor.solve(rows.rows.transpose());
  const RowMatrix reaction = rows.rows * push;
  const RowVector breach = rows.breach(asked);
  return asked - push * PushingRows(reaction, breach).multipliers();
}

/// @param torque Of the joints.
bool can_hold(const model::RobotParameters& robot, const core::LegVector& torque,
              const core::LegVector& dq) {
  constexpr double kSlack = 1e-6;  // [N·m]
  return (model::saturate(robot, torque, dq) - torque).cwiseAbs().maxCoeff() <= kSlack;
}

}  // namespace

WrenchLimiter::WrenchLimiter(const WrenchMpcConfig& config, const model::RobotParameters& robot)
    : robot_(robot), cone_(constant_part(config, robot).cone) {}

core::JointVector WrenchLimiter::limit(const core::RobotState& state, const core::JointVector& base,
                                       core::ContactWrenches& wrenches) const noexcept {
  const core::JointVector asked = contact_torques(robot_, state, wrenches);
  bool replaced = false;
  for (const core::Leg leg : core::kAllLegs) {
    const auto of_leg = [leg](const core::JointVector& v) {
      return core::LegVector(v.segment<core::kJointsPerLeg>(core::leg_offset(leg)));
    };
    if (can_hold(robot_, of_leg(base) + of_leg(asked), of_leg(state.dq))) continue;
    const Eigen::Isometry3d sole = model::sole_poses(robot_, state)[core::index(leg)];
    const double yaw = std::atan2(sole.linear()(1, 0), sole.linear()(0, 0));
    const LegMap motors = motor_columns(robot_, leg, state, yaw);
    Rows rows;
    add_motors(robot_, motors, of_leg(base), of_leg(state.dq), rows);
    add_cone(cone_, rows);
    core::Wrench& wrench = wrenches[core::index(leg)];
    wrench =
        foot_wrench(nearest(rows, torque_metric(robot_, motors), foot_input(wrench, yaw)), yaw);
    replaced = true;
  }
  return replaced ? contact_torques(robot_, state, wrenches) : asked;
}

}  // namespace hopscotch::control
