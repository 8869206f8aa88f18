#pragma once

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "core/config_reader.hpp"
#include "core/result.hpp"
#include "core/robot_state.hpp"
#include "core/time.hpp"

namespace hopscotch::perception {

/// When a calibration is trusted; section `perception.calibration`.
struct CalibrationConfig {
  double ground_gate = 0.0;         ///< Points farther from the soles' plane are not ground [m].
  double ground_gate_last = 0.0;    ///< The same once the pose is known well [m].
  double loss_width = 0.0;          ///< Of the Cauchy loss [m].
  double position_sigma_max = 0.0;  ///< [m]
  double angle_sigma_max = 0.0;     ///< [rad]
  double time_sigma_max = 0.0;      ///< [s]
  double time_offset_max = 0.0;     ///< Searched to either side [s].
  int block_frames = 1;             ///< Errors of so many frames in a row may be one error.

  static CalibrationConfig load(const core::ConfigReader& section);
};

/// Trusted pixels of one depth frame, far enough apart that their errors are their own.
struct CalibrationFrame {
  core::Stamp stamp;                      ///< As the camera states it.
  std::vector<Eigen::Vector3d> points_C;  ///< [m]
  std::vector<double> sigmas;             ///< Of each point's depth [m].
};

/// Where the trunk is over the plane of two soles that bear load. Frame G: its plane z = 0 is that
/// of the soles, its axes are W's.
struct TrunkSample {
  core::Stamp stamp;
  Eigen::Isometry3d X_GB = Eigen::Isometry3d::Identity();
  Eigen::Vector3d v_GB = Eigen::Vector3d::Constant(core::kNaN);  ///< [m/s]
  Eigen::Vector3d w_GB = Eigen::Vector3d::Constant(core::kNaN);  ///< In G [rad/s].
};

struct CalibrationData {
  Eigen::Isometry3d X_BC = Eigen::Isometry3d::Identity();  ///< Mounting as believed so far.
  std::vector<CalibrationFrame> frames;                    ///< By time.
  std::vector<TrunkSample> trunk;  ///< By time, 50 a second and more; none in flight.
};

/// The numbers that are fitted. One level floor does not tell the camera's y and yaw: they are kept
/// as believed.
enum class Fitted : std::uint8_t { x, z, roll, pitch, time };
inline constexpr int kFitted = 5;

/// A mounting pose and what is known of its error.
struct CameraCalibration {
  Eigen::Isometry3d X_BC = Eigen::Isometry3d::Identity();
  double time_offset = 0.0;  ///< To be added to the camera's stamps [s].
  /// Of x, z [m], rotation about x and y of B [rad] and time offset [s], in the order of `Fitted`.
  Eigen::Matrix<double, kFitted, kFitted> covariance =
      Eigen::Matrix<double, kFitted, kFitted>::Constant(core::kNaN);
  double residual = 0.0;  ///< Root mean square height of ground points [m].
  int points = 0;         ///< That were ground.
  int frames = 0;         ///< That held some.

  /// Standard deviation of one number [m, rad or s].
  [[nodiscard]] double sigma(Fitted number) const;
};

/// Fits mounting and time offset so that the ground seen lies in the plane that the soles stand on.
/// @return terrain_unseen when there is too little ground or motion to determine each number within
///         its allowed standard deviation: the sentence names the number and what to record.
[[nodiscard]] core::Result<CameraCalibration> calibrate_camera(const CalibrationConfig& config,
                                                               const CalibrationData& data);

}  // namespace hopscotch::perception
