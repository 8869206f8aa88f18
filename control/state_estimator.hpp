#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "control/contact_detector.hpp"
#include "control/estimator_config.hpp"
#include "control/flight_check.hpp"
#include "control/invariant_filter.hpp"
#include "core/robot_state.hpp"
#include "core/sensor_readings.hpp"
#include "model/robot_parameters.hpp"

namespace hopscotch::control {

/// Where the robot is put down: this is what places W.
struct StartPlace {
  Eigen::Vector3d p_WS = Eigen::Vector3d::Zero();  ///< Mid-point of the soles [m].
  double yaw = 0.0;                                ///< Of the trunk [rad].
};

/// Counts of what went wrong and was dealt with.
struct EstimatorCounts {
  std::uint64_t slips = 0;            ///< A standing foot was not where it had been.
  std::uint64_t heights_used = 0;     ///< Map heights that passed the gate.
  std::uint64_t heights_refused = 0;  ///< Those that did not.
  std::uint64_t flights_doubted = 0;  ///< They led to a vertical speed that did not fit the soles.
  std::uint64_t bad_readings = 0;     ///< Not finite: passed on as they are, not filtered.
};

/// SensorReadings -> RobotState, from inertial sensor and encoders alone: an invariant Kalman
/// filter with the soles that bear load as landmarks, and pure inertial propagation in flight.
/// Heading and place drift, slowly; velocity and tilt do not. Real-time: `update` does not
/// allocate, lock or throw.
class StateEstimator {
 public:
  StateEstimator(const EstimatorConfig& config, const model::RobotParameters& robot,
                 const StartPlace& start);

  /// One exchange with the sensors. The first reading starts the filter: soles level, at rest.
  /// Readings with the stamp of the last ones change nothing.
  const core::RobotState& update(const core::SensorReadings& readings,
                                 ContactExpectation expected) noexcept;

  /// The map says how high the standing soles are now [m].
  void correct_height(double height) noexcept;

  [[nodiscard]] const core::RobotState& state() const { return state_; }
  /// @pre update() has run on finite readings.
  [[nodiscard]] const InvariantFilter& filter() const { return *filter_; }
  [[nodiscard]] const ContactDetector& contacts() const { return detector_; }
  [[nodiscard]] const EstimatorCounts& counts() const { return counts_; }

 private:
  [[nodiscard]] FilterState first_guess(const core::SensorReadings& readings) const noexcept;
  void use_feet(const core::SensorReadings& readings, ContactExpectation expected,
                double dt) noexcept;
  void check_flight(const core::SensorReadings& readings, double dt) noexcept;
  [[nodiscard]] SeenFoot see(core::Leg leg, const core::JointVector& q) const noexcept;
  [[nodiscard]] double creep(core::Leg leg, const core::SensorReadings& readings) const noexcept;
  void publish(const core::SensorReadings& readings) noexcept;

  EstimatorConfig config_;
  model::RobotParameters robot_;
  StartPlace start_;
  ContactDetector detector_;
  FlightCheck flight_check_;
  std::optional<InvariantFilter> filter_;
  std::array<double, core::kLegs> standing_for_{};  ///< Since touchdown [s].
  core::RobotState state_;
  EstimatorCounts counts_;
};

}  // namespace hopscotch::control
