#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "apps/bench.hpp"
#include "apps/lockstep_run.hpp"
#include "model/kinematics.hpp"

namespace hopscotch::apps {

namespace {

using core::RobotPhase;

constexpr const char* kLongGround =
    "name: long-ground\n"
    "slabs:\n"
    "  - {x_m: [-1.0, 100.0], y_m: [-20.0, 20.0]}\n"
    "goal: {jumps: 20}\n";

double yaw_of(const core::RobotState& state) {
  return model::rpy_from_rotation(state.R_WB).z();
}

/// Where the trunk went since `from`, along and across the heading it had there [m].
Eigen::Vector3d travel(const core::RobotState& from, const core::RobotState& to) {
  return model::rotation_from_rpy({0.0, 0.0, -yaw_of(from)}) * (to.p_WB - from.p_WB);
}

double root_mean_square(const std::vector<double>& samples) {
  if (samples.empty()) return core::kNaN;
  const double sum = std::inner_product(samples.begin(), samples.end(), samples.begin(), 0.0);
  return std::sqrt(sum / static_cast<double>(samples.size()));
}

/// Errors of the estimate against the plant's truth, jump by jump.
class EstimatorScore {
 public:
  void update(const TickRecord& tick, const control::InvariantFilter& filter) {
    const bool contact = tick.truth.state.contact[0] || tick.truth.state.contact[1];
    const RobotPhase phase = tick.status.phase;
    if (phase == RobotPhase::crouch && phase_ != RobotPhase::crouch) {
      from_ = {tick.state, tick.truth.state};
      flown_ = touched_ = false;
    }
    if (phase == RobotPhase::flight && !contact) flown_ = true;
    if (flown_ && contact && !touched_) touchdown(tick);
    if (phase == RobotPhase::landing && phase_ == RobotPhase::flight) detect(tick);
    if (phase_ == RobotPhase::landing && phase != RobotPhase::landing) landed(tick);
    phase_ = phase;
    add_consistency(tick, filter);
  }

  std::vector<double> pitch, landing, touchdown_ms;
  int false_touchdowns = 0;
  double consistency_sum = 0.0;
  std::size_t consistency_count = 0;

 private:
  struct Both {
    core::RobotState used, truth;
  };

  void touchdown(const TickRecord& tick) {
    touched_ = true;
    touchdown_ = tick.truth.state.stamp;
    pitch.push_back(model::rpy_from_rotation(tick.state.R_WB).y() -
                    model::rpy_from_rotation(tick.truth.state.R_WB).y());
  }

  void detect(const TickRecord& tick) {
    if (!touched_) {
      ++false_touchdowns;
      return;
    }
    touchdown_ms.push_back(1e3 * tick.truth.state.stamp.since(touchdown_));
  }

  void landed(const TickRecord& tick) {
    landing.push_back(
        (travel(from_.used, tick.state) - travel(from_.truth, tick.truth.state)).norm());
  }

  /// Squared error of attitude and velocity over its own covariance; six if that is honest.
  void add_consistency(const TickRecord& tick, const control::InvariantFilter& filter) {
    if (phase_ == RobotPhase::stand && tick.truth.state.stamp.seconds() < 0.2) return;
    const Eigen::Matrix3d error = tick.state.R_WB * tick.truth.state.R_WB.transpose();
    const Eigen::AngleAxisd turn(error);
    Eigen::Vector<double, 6> xi;
    xi << turn.angle() * turn.axis(), tick.state.v_WB - error * tick.truth.state.v_WB;
    const Eigen::Matrix<double, 6, 6> P = filter.covariance().topLeftCorner<6, 6>();
    consistency_sum += xi.dot(P.ldlt().solve(xi));
    ++consistency_count;
  }

  RobotPhase phase_ = RobotPhase::stand;
  Both from_;
  core::Stamp touchdown_;
  bool flown_ = false;
  bool touched_ = false;
};

}  // namespace

nlohmann::ordered_json bench_estimator(const BenchSetup& setup, int jumps) {
  constexpr int kJumpsPerRun = 20;
  EstimatorScore score;
  std::vector<double> update_ms;
  std::vector<double> takeoff;
  int falls = 0;
  int done = 0;
  for (std::uint64_t seed = 1; done < jumps; ++seed) {
    RunRequest request = level_ground_run(setup, Eyes::truth);
    request.scenario = sim::Scenario::from_text(kLongGround, "long ground");
    request.seed = seed;
    request.scenario.goal.jumps = std::min(kJumpsPerRun, jumps - done);
    LockstepRun run(request);
    const auto observe = [&](const TickRecord& tick) {
      score.update(tick, run.pipeline().estimator().filter());
    };
    while (run.step(observe)) {
    }
    const RunResult result = run.result();
    for (const JumpResult& jump : result.jumps) {
      if (std::isfinite(jump.takeoff.estimate_error)) {
        takeoff.push_back(jump.takeoff.estimate_error);
      }
    }
    falls += result.falls;
    done += *request.scenario.goal.jumps;
    const std::vector<double>& times = run.samples().estimator_ms;
    update_ms.insert(update_ms.end(), times.begin(), times.end());
  }
  const std::size_t n = update_ms.size();
  return {{"n", n},
          {"jumps", takeoff.size()},
          {"update_us", percentile_group(std::move(update_ms), 1e3)},
          {"takeoff_speed_rmse_mps", root_mean_square(takeoff)},
          {"pitch_rmse_rad", root_mean_square(score.pitch)},
          {"landing_rmse_m", root_mean_square(score.landing)},
          {"touchdown_ms", percentile_group(score.touchdown_ms, 1.0)},
          {"false_touchdowns", score.false_touchdowns},
          {"falls", falls},
          {"nees_of_six", score.consistency_sum / static_cast<double>(score.consistency_count)}};
}

}  // namespace hopscotch::apps
