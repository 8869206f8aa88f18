#include "apps/calibration_log.hpp"

#include <array>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "core/config_reader.hpp"
#include "model/kinematics.hpp"
#include "msgs/run_log.hpp"
#include "perception/body_mask.hpp"
#include "perception/depth_filter.hpp"
#include "perception/depth_noise.hpp"

namespace hopscotch::apps {

namespace {

/// Errors of pixels so far apart are independent.
constexpr int kPixelStep = 24;

/// Soles that are tilted by more have their heels off the ground [rad].
constexpr double kSoleTiltMax = 0.015;

/// A trunk slower than this stands: its soles rest flat on the ground.
constexpr double kStandingSpeed = 0.05;         // [m/s]
constexpr double kStandingAngularSpeed = 0.15;  // [rad/s]

/// Normal of the plane of both soles, in W, by the legs. NaN in, NaN out.
Eigen::Vector3d normal_of_soles(const std::array<Eigen::Isometry3d, core::kLegs>& X_WF) {
  const Eigen::Vector3d left = X_WF[core::index(core::Leg::left)].translation();
  const Eigen::Vector3d right = X_WF[core::index(core::Leg::right)].translation();
  const Eigen::Vector3d ahead = X_WF[0].linear().col(0) + X_WF[1].linear().col(0);
  return ahead.cross(left - right).normalized();
}

/// Collects frames, and where the trunk was over the plane of both soles.
class Collector {
 public:
  Collector(const perception::PerceptionConfig& config, const model::RobotParameters& robot)
      : config_(config), robot_(robot), filter_(config.filter, config.noise) {}

  void state(const core::RobotState& state) {
    if (!data_.trunk.empty() && state.stamp <= data_.trunk.back().stamp) return;
    if (!state.contact[0] || !state.contact[1]) return;
    const auto soles = model::sole_poses(robot_, state);
    const Eigen::Vector3d normal = normal_of_soles(soles);
    const bool flat = normal.z() >= std::cos(kSoleTiltMax);
    if (!flat || !state.v_WB.allFinite() || !state.w_WB.allFinite()) return;
    const Eigen::Vector3d middle = 0.5 * (soles[0].translation() + soles[1].translation());
    perception::TrunkSample sample{
        .stamp = state.stamp, .X_GB = {}, .v_GB = state.v_WB, .w_GB = state.w_WB};
    sample.X_GB = Eigen::Isometry3d::Identity();
    sample.X_GB.linear() = state.R_WB;
    sample.X_GB.translation() = state.p_WB - middle;
    data_.trunk.push_back(sample);
    const bool stands =
        state.v_WB.norm() < kStandingSpeed && state.w_WB.norm() < kStandingAngularSpeed;
    if (stands) standing_normal_ += normal;
  }

  void depth(const core::DepthFrame& frame, const core::RobotState& at_exposure) {
    ++frames_;
    data_.X_BC = frame.X_BC;
    perception::CalibrationFrame points{.stamp = frame.stamp, .points_C = {}, .sigmas = {}};
    (void)filter_.filter(frame, perception::body_in_camera(robot_, at_exposure.q, frame.X_BC),
                         depth_);
    const core::CameraIntrinsics& lens = frame.intrinsics;
    for (int v = kPixelStep / 2; v < lens.height; v += kPixelStep) {
      for (int u = kPixelStep / 2; u < lens.width; u += kPixelStep) {
        const double z = static_cast<double>(depth_[static_cast<std::size_t>(v * lens.width + u)]);
        if (!(z > 0.0)) continue;
        points.points_C.emplace_back(z * (u - lens.cx) / lens.fx, z * (v - lens.cy) / lens.fy, z);
        points.sigmas.push_back(perception::depth_sigma(config_.noise, z));
      }
    }
    data_.frames.push_back(std::move(points));
  }

  [[nodiscard]] int frames() const { return frames_; }
  /// The state estimate is off in roll and pitch by what the accelerometers are off. The legs are
  /// not, while the robot stands, so the mean plane of its soles says what level is.
  [[nodiscard]] perception::CalibrationData take() {
    if (standing_normal_.norm() > 0.0) {
      const Eigen::Quaterniond level =
          Eigen::Quaterniond::FromTwoVectors(standing_normal_, Eigen::Vector3d::UnitZ());
      for (perception::TrunkSample& sample : data_.trunk) {
        sample.X_GB = level * sample.X_GB;
        sample.v_GB = level * sample.v_GB;
        sample.w_GB = level * sample.w_GB;
      }
    }
    return std::move(data_);
  }

 private:
  const perception::PerceptionConfig& config_;
  const model::RobotParameters& robot_;
  perception::DepthFilter filter_;
  std::vector<float> depth_;
  int frames_ = 0;
  Eigen::Vector3d standing_normal_ = Eigen::Vector3d::Zero();  ///< Sum, in W.
  perception::CalibrationData data_;
};

}  // namespace

perception::CalibrationData read_calibration_log(const std::filesystem::path& log,
                                                 const perception::PerceptionConfig& config,
                                                 const model::RobotParameters& robot) {
  const auto reject = [&](const std::string& why) {
    throw core::ConfigError(log.string() + ": " + why);
  };
  if (!std::filesystem::is_regular_file(log)) reject("is no file");
  Collector collector(config, robot);
  msgs::RunLogHandlers on;
  on.state = [&](core::Stamp, const auto& message) { collector.state(message.value); };
  on.depth = [&](core::Stamp, const auto& message) {
    collector.depth(message.value.frame, message.value.at_exposure);
  };
  const msgs::RunLogSummary read = msgs::read_run_log(log, on);
  if (read.events == 0) reject("is no LCM log: it holds no message");
  if (read.cut_short) reject("is cut short or damaged");
  if (read.malformed > 0) reject("holds messages that cannot be decoded");
  if (collector.frames() == 0) {
    reject("holds no depth frames; record with `hopscotch run --log-depth`");
  }
  return collector.take();
}

}  // namespace hopscotch::apps
