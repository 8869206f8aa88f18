#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>

#include "control/estimator_config.hpp"
#include "control/flight_check.hpp"
#include "core/robot_layout.hpp"

namespace hopscotch::control {

/// What the filter estimates.
struct FilterState {
  Eigen::Matrix3d R_WB = Eigen::Matrix3d::Identity();
  Eigen::Vector3d v_WB = Eigen::Vector3d::Zero();  ///< [m/s]
  Eigen::Vector3d p_WB = Eigen::Vector3d::Zero();  ///< [m]
  std::array<Eigen::Vector3d, core::kLegs> p_WF{Eigen::Vector3d::Zero(),
                                                Eigen::Vector3d::Zero()};  ///< Standing soles [m].
  Eigen::Vector3d gyro_bias = Eigen::Vector3d::Zero();                     ///< In B [rad/s].
  Eigen::Vector3d accelerometer_bias = Eigen::Vector3d::Zero();            ///< In B [m/s^2].
};

/// A sole seen from the trunk through the leg's encoders.
struct SeenFoot {
  Eigen::Vector3d p_BF;        ///< [m]
  Eigen::Matrix3d covariance;  ///< In B [m^2].
};

enum class FootVerdict : std::uint8_t { fits, slipped };

/// Contact-aided right-invariant extended Kalman filter (Hartley et al. 2020) over attitude,
/// velocity, position, the standing soles and the biases of the inertial sensor. The errors are
/// those of X = (R, v, p, p_F) on the left, in W, so that their dynamics do not depend on the
/// motion; heading and place are not observable and their uncertainty grows.
/// Real-time: nothing allocates, locks or throws.
class InvariantFilter {
 public:
  /// Order of the error state: attitude, velocity, position, left sole, right sole, gyro bias,
  /// accelerometer bias; three each.
  static constexpr int kSize = 21;
  static constexpr int kAttitude = 0;
  static constexpr int kVelocity = 3;
  static constexpr int kPosition = 6;
  static constexpr int kSole = 9;
  static constexpr int kGyroBias = 15;
  static constexpr int kForceBias = 18;
  using Covariance = Eigen::Matrix<double, kSize, kSize>;

  /// @param start Place and attitude believed at start-up; biases zero, no foot stands.
  InvariantFilter(const FilterConfig& config, const FilterState& start);

  /// One step of the inertial sensor.
  /// @param rate    Gyroscope, mean or end of the step, in B [rad/s].
  /// @param force   Specific force, mean of the step, in B [m/s^2].
  /// @param density How far a standing foot may creep, per foot [m/sqrt(s)].
  void propagate(const Eigen::Vector3d& rate, const Eigen::Vector3d& force, double dt,
                 const std::array<double, core::kLegs>& density) noexcept;

  /// A foot begins to stand where it is seen now.
  void add_foot(core::Leg leg, const SeenFoot& seen) noexcept;
  /// A foot no longer stands; does nothing if it did not.
  void remove_foot(core::Leg leg) noexcept;
  [[nodiscard]] bool stands(core::Leg leg) const { return standing_[core::index(leg)]; }

  /// A standing foot is where it was. If it is not, beyond the gate, it has slipped: its place is
  /// taken anew.
  FootVerdict correct_foot(core::Leg leg, const SeenFoot& seen) noexcept;

  /// The vertical speed turned out to be wrong by `error` after a flight, of which nothing had been
  /// expected: from now on it is as uncertain as that, and with it the height of all, which the
  /// same error of the inertial sensor made wrong. The next corrections find both.
  void doubt_flight(const FlightError& error) noexcept;

  /// The map says how high a standing sole is [m]; ignored beyond the gate. True if used.
  bool correct_height(core::Leg leg, double height) noexcept;

  [[nodiscard]] const FilterState& state() const { return state_; }
  /// Of the error state; rows of feet that do not stand are zero.
  [[nodiscard]] const Covariance& covariance() const { return covariance_; }

 private:
  void move_covariance(double dt) noexcept;
  void add_noise(const Eigen::Vector3d& force, double dt,
                 const std::array<double, core::kLegs>& density) noexcept;
  void apply(const Eigen::Vector<double, kSize>& error) noexcept;

  FilterConfig config_;
  FilterState state_;
  Covariance covariance_ = Covariance::Zero();
  std::array<bool, core::kLegs> standing_{};
};

}  // namespace hopscotch::control
