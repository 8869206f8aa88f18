#include "perception/camera_calibration.hpp"

#include <ceres/ceres.h>
#include <ceres/rotation.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <optional>
#include <utility>

namespace hopscotch::perception {

namespace {

using Eigen::Vector3d;
using Covariance = Eigen::Matrix<double, kFitted, kFitted>;
/// What is added to the present numbers, in the order of `Fitted`.
using Correction = std::array<double, kFitted>;

constexpr int kPointsMin = 500;
/// The motion is linearised about the present offset, so the fit is repeated with the new one.
constexpr int kRounds = 6;
/// The soles may rest on the ground tilted by this for a whole log; no scatter tells it [rad].
constexpr double kAttitudeSigma = 0.0015;

constexpr std::size_t index(Fitted number) {
  return static_cast<std::size_t>(number);
}

std::optional<TrunkSample> trunk_at(const std::vector<TrunkSample>& samples, core::Stamp t) {
  const auto behind =
      std::lower_bound(samples.begin(), samples.end(), t,
                       [](const TrunkSample& s, core::Stamp stamp) { return s.stamp < stamp; });
  if (behind == samples.begin() || behind == samples.end()) return std::nullopt;
  const TrunkSample& a = *(behind - 1);
  const TrunkSample& b = *behind;
  constexpr double kGapMax = 0.02;  // [s]
  const double span = b.stamp.since(a.stamp);
  if (!(span > 0.0) || span > kGapMax) return std::nullopt;
  const double share = t.since(a.stamp) / span;
  TrunkSample between{.stamp = t};
  const Eigen::Quaterniond from(a.X_GB.linear());
  const Eigen::Quaterniond to(b.X_GB.linear());
  between.X_GB.linear() = from.slerp(share, to).toRotationMatrix();
  between.X_GB.translation() = (1.0 - share) * a.X_GB.translation() + share * b.X_GB.translation();
  between.v_GB = (1.0 - share) * a.v_GB + share * b.v_GB;
  between.w_GB = (1.0 - share) * a.w_GB + share * b.w_GB;
  return between;
}

/// Height of one point over the plane of the soles, over its standard deviation.
struct GroundResidual {
  TrunkSample trunk;  // at the frame's stamp plus the present offset
  Vector3d p_BC;
  Vector3d p_CP_B;  // camera to point, turned into B by the present mounting
  double sigma = 0.0;
  std::size_t frame = 0;

  template <typename T>
  bool operator()(const T* correction, T* residual) const {
    const T turn[3] = {correction[index(Fitted::roll)], correction[index(Fitted::pitch)], T(0.0)};
    const T time = correction[index(Fitted::time)];
    const T arm[3] = {T(p_CP_B.x()), T(p_CP_B.y()), T(p_CP_B.z())};
    T turned[3];
    ceres::AngleAxisRotatePoint(turn, arm, turned);
    const T in_B[3] = {T(p_BC.x()) + correction[index(Fitted::x)] + turned[0],
                       T(p_BC.y()) + turned[1],
                       T(p_BC.z()) + correction[index(Fitted::z)] + turned[2]};
    const Eigen::Matrix3d R = trunk.X_GB.linear();
    T in_G[3];
    for (int i = 0; i < 3; ++i) {
      in_G[i] = R(i, 0) * in_B[0] + R(i, 1) * in_B[1] + R(i, 2) * in_B[2];
    }
    // The trunk moves on for the rest of the offset.
    const T spin[3] = {trunk.w_GB.x() * time, trunk.w_GB.y() * time, trunk.w_GB.z() * time};
    T moved[3];
    ceres::AngleAxisRotatePoint(spin, in_G, moved);
    residual[0] = (trunk.X_GB.translation().z() + trunk.v_GB.z() * time + moved[2]) / sigma;
    return true;
  }
};

struct Present {
  Eigen::Isometry3d X_BC;
  double time_offset = 0.0;
  double gate = 0.0;  // [m]
};

std::vector<GroundResidual> residuals_of(const CalibrationData& data, const Present& present) {
  std::vector<GroundResidual> residuals;
  for (std::size_t f = 0; f < data.frames.size(); ++f) {
    const CalibrationFrame& frame = data.frames[f];
    const auto trunk = trunk_at(data.trunk, frame.stamp.after(present.time_offset));
    if (!trunk) continue;
    for (std::size_t i = 0; i < frame.points_C.size(); ++i) {
      const Vector3d arm = present.X_BC.linear() * frame.points_C[i];
      const Vector3d p = trunk->X_GB * (present.X_BC.translation() + arm);
      if (!(std::abs(p.z()) <= present.gate)) continue;
      const double drop = std::abs((trunk->X_GB.linear() * arm).z());
      constexpr double kSigmaMin = 1e-3;
      const double sigma = std::max(kSigmaMin, frame.sigmas[i] * drop / frame.points_C[i].z());
      residuals.push_back({*trunk, present.X_BC.translation(), arm, sigma, f});
    }
  }
  return residuals;
}

/// One least-squares problem about the present numbers.
struct Fit {
  Fit(const CalibrationConfig& config, const std::vector<GroundResidual>& residuals,
      double time_offset) {
    for (const GroundResidual& residual : residuals) {
      problem.AddResidualBlock(
          new ceres::AutoDiffCostFunction<GroundResidual, 1, kFitted>(new GroundResidual(residual)),
          new ceres::CauchyLoss(config.loss_width / residual.sigma), correction.data());
    }
    const int time = static_cast<int>(Fitted::time);
    problem.SetParameterLowerBound(correction.data(), time, -config.time_offset_max - time_offset);
    problem.SetParameterUpperBound(correction.data(), time, config.time_offset_max - time_offset);
  }

  bool solve() {
    ceres::Solver::Options options;
    options.linear_solver_type = ceres::DENSE_NORMAL_CHOLESKY;  // five unknowns
    options.logging_type = ceres::SILENT;
    ceres::Solver::Summary summary;
    ceres::Solve(options, &problem, &summary);
    return summary.IsSolutionUsable();
  }

  /// From the curvature, as if the errors of all points were their own.
  std::optional<Covariance> curvature_covariance() {
    ceres::Covariance::Options options;
    options.algorithm_type = ceres::DENSE_SVD;
    ceres::Covariance covariance(options);
    const std::vector<std::pair<const double*, const double*>> blocks{
        {correction.data(), correction.data()}};
    if (!covariance.Compute(blocks, &problem)) return std::nullopt;
    Eigen::Matrix<double, kFitted, kFitted, Eigen::RowMajor> matrix;
    covariance.GetCovarianceBlock(correction.data(), correction.data(), matrix.data());
    return matrix;
  }

  Correction correction{};
  ceres::Problem problem;
};

/// Covariance when the errors of a block of frames hang together, as those of a stance or of a
/// state estimate do: the curvature's, with the scatter of the blocks' own pulls between.
Covariance block_covariance(const std::vector<GroundResidual>& residuals, int block_frames,
                            const Covariance& curvature, Fit& fit) {
  std::vector<double> values;
  ceres::CRSMatrix jacobian;
  fit.problem.Evaluate({}, nullptr, &values, nullptr, &jacobian);
  Covariance scatter = Covariance::Zero();
  Eigen::Vector<double, kFitted> pull = Eigen::Vector<double, kFitted>::Zero();
  const std::size_t length = static_cast<std::size_t>(block_frames);
  int blocks = 0;
  for (std::size_t i = 0; i < residuals.size(); ++i) {
    for (std::size_t k = 0; k < kFitted; ++k) {
      pull[static_cast<Eigen::Index>(k)] += jacobian.values[i * kFitted + k] * values[i];
    }
    const std::size_t block = residuals[i].frame / length;
    if (i + 1 < residuals.size() && residuals[i + 1].frame / length == block) continue;
    scatter += pull * pull.transpose();
    pull.setZero();
    ++blocks;
  }
  const double few = static_cast<double>(blocks) / std::max(1, blocks - kFitted);
  const Covariance by_blocks = few * curvature * scatter * curvature;
  const double n = static_cast<double>(residuals.size());
  double square = 0.0;
  for (const double value : values) square += value * value;
  // Never better than the points alone allow.
  Covariance sum = by_blocks + std::max(1.0, square / n) * curvature;
  for (const Fitted angle : {Fitted::roll, Fitted::pitch}) {
    const auto i = static_cast<Eigen::Index>(angle);
    sum(i, i) += kAttitudeSigma * kAttitudeSigma;
  }
  return sum;
}

Present corrected(const CalibrationConfig& config, const Present& present,
                  const Correction& correction) {
  Present next = present;
  const Vector3d turn(correction[index(Fitted::roll)], correction[index(Fitted::pitch)], 0.0);
  if (const double angle = turn.norm(); angle > 0.0) {
    next.X_BC.linear() =
        Eigen::AngleAxisd(angle, turn / angle).toRotationMatrix() * present.X_BC.linear();
  }
  next.X_BC.translation() +=
      Vector3d(correction[index(Fitted::x)], 0.0, correction[index(Fitted::z)]);
  next.time_offset += correction[index(Fitted::time)];
  constexpr double kNarrower = 0.6;  // a round, as far as the last gate
  next.gate = std::max(config.ground_gate_last, kNarrower * present.gate);
  return next;
}

core::Refusal refusal(const std::string& sentence) {
  return {core::Reason::terrain_unseen, sentence};
}

/// Names the first number that the log does not determine.
std::optional<core::Refusal> undetermined(const CalibrationConfig& config,
                                          const Covariance& covariance) {
  const struct {
    const char* name;
    Fitted number;
    double limit;
    double scale;
    const char* unit;
  } kChecks[] = {{"the time offset", Fitted::time, config.time_sigma_max, 1e3, "ms"},
                 {"the camera's distance ahead", Fitted::x, config.position_sigma_max, 1e3, "mm"},
                 {"the camera's height", Fitted::z, config.position_sigma_max, 1e3, "mm"},
                 {"the camera's pitch", Fitted::pitch, config.angle_sigma_max, 57.29578, "deg"},
                 {"the camera's roll", Fitted::roll, config.angle_sigma_max, 57.29578, "deg"}};
  for (const auto& check : kChecks) {
    const auto i = static_cast<Eigen::Index>(check.number);
    const double sigma = std::sqrt(covariance(i, i));
    if (sigma <= check.limit) continue;
    char text[240];
    std::snprintf(text, sizeof text,
                  "the log does not determine %s: its standard deviation is %.2g %s, %.2g is "
                  "allowed; record one with several jumps over level ground, which pitch the trunk "
                  "by over 10 degrees",
                  check.name, check.scale * sigma, check.unit, check.scale * check.limit);
    return refusal(text);
  }
  return std::nullopt;
}

core::Refusal too_few(std::size_t points) {
  return refusal("only " + std::to_string(points) +
                 " points lie near the plane of the standing soles; " + std::to_string(kPointsMin) +
                 " are needed");
}

core::Refusal no_motion() {
  return refusal("the log does not determine pose and time offset: the trunk hardly moves");
}

int frames_in(const std::vector<GroundResidual>& residuals) {
  int frames = residuals.empty() ? 0 : 1;
  for (std::size_t i = 1; i < residuals.size(); ++i) {
    frames += residuals[i].frame != residuals[i - 1].frame ? 1 : 0;
  }
  return frames;
}

double mean_height(const std::vector<GroundResidual>& residuals, const Correction& correction) {
  double square = 0.0;
  for (const GroundResidual& residual : residuals) {
    double value = 0.0;
    residual(correction.data(), &value);
    square += value * value * residual.sigma * residual.sigma;
  }
  return std::sqrt(square / static_cast<double>(residuals.size()));
}

}  // namespace

CalibrationConfig CalibrationConfig::load(const core::ConfigReader& section) {
  using core::Range;
  CalibrationConfig config;
  config.ground_gate = section.number("ground_gate_m", Range::above(0.0, 0.5));
  config.ground_gate_last = section.number("ground_gate_last_m", Range::above(0.0, 0.5));
  if (config.ground_gate_last > config.ground_gate) {
    section.reject("ground_gate_last_m", "must not be larger than ground_gate_m");
  }
  config.loss_width = section.number("loss_width_m", Range::above(0.0, 0.1));
  config.position_sigma_max = section.number("position_sigma_max_m", Range::positive());
  config.angle_sigma_max = section.number("angle_sigma_max_rad", Range::positive());
  config.time_sigma_max = section.number("time_sigma_max_s", Range::positive());
  config.time_offset_max = section.number("time_offset_max_s", Range::above(0.0, 0.5));
  config.block_frames = section.integer("block_frames", 1, 1000);
  section.finish();
  return config;
}

double CameraCalibration::sigma(Fitted number) const {
  const auto i = static_cast<Eigen::Index>(number);
  return std::sqrt(covariance(i, i));
}

core::Result<CameraCalibration> calibrate_camera(const CalibrationConfig& config,
                                                 const CalibrationData& data) {
  Present present{.X_BC = data.X_BC, .time_offset = 0.0, .gate = config.ground_gate};
  CameraCalibration result;
  for (int round = 0; round < kRounds; ++round) {
    const std::vector<GroundResidual> residuals = residuals_of(data, present);
    if (residuals.size() < static_cast<std::size_t>(kPointsMin)) return too_few(residuals.size());
    Fit fit(config, residuals, present.time_offset);
    if (round == 0) {  // before a fit along what is not determined leads astray
      const std::optional<Covariance> curvature = fit.curvature_covariance();
      if (!curvature) return no_motion();
      if (const auto no = undetermined(config, *curvature)) return *no;
    }
    if (!fit.solve()) return refusal("the fit did not converge");
    if (round + 1 == kRounds) {
      const std::optional<Covariance> curvature = fit.curvature_covariance();
      if (!curvature) return no_motion();
      result.covariance = block_covariance(residuals, config.block_frames, *curvature, fit);
      result.residual = mean_height(residuals, fit.correction);
      result.points = static_cast<int>(residuals.size());
      result.frames = frames_in(residuals);
    }
    present = corrected(config, present, fit.correction);
  }
  result.X_BC = present.X_BC;
  result.time_offset = present.time_offset;
  if (const auto no = undetermined(config, result.covariance)) return *no;
  constexpr double kAtLimit = 0.999;
  if (std::abs(result.time_offset) > kAtLimit * config.time_offset_max) {
    return refusal("the time offset lies at the end of what is searched");
  }
  return result;
}

}  // namespace hopscotch::perception
