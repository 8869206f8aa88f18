#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

#include "apps/evidence.hpp"
#include "model/kinematics.hpp"
#include "model/motor.hpp"

/// One function per cause. Thresholds lie above what jumps that end well show; docs/explain.md has
/// the figures.
namespace hopscotch::apps {

namespace {

using core::RobotPhase;

constexpr double kGravity = 9.81;        // [m/s^2]
constexpr double kPushInFlight = 1.5;    // momentum out of nowhere, in the air [N·s]
constexpr double kPushOnGround = 6.0;    // the same on the ground, beyond what impacts blur [N·s]
constexpr double kPushWindow = 0.15;     // [s]
constexpr double kSlip = 0.03;           // path of a loaded sole [m]
constexpr double kSlipSpeed = 0.15;      // [m/s]
constexpr double kLoaded = 30.0;         // [N]
constexpr double kTouch = 20.0;          // [N]
constexpr double kClearOfGround = 0.06;  // after lift-off and before touchdown as planned [s]
constexpr double kHeightError = 0.015;   // [m]
constexpr double kPlaceError = 0.06;     // [m]
constexpr double kTakeoffError = 0.20;   // [m/s]
constexpr double kSaturated = 0.995;     // share of a limit
constexpr double kSaturatedTime = 0.15;  // [s]
constexpr double kContactTime = 0.03;    // of wrong contact [s]
constexpr double kPositionError = 0.08;  // of the state used [m]
constexpr double kVelocityError = 0.30;  // [m/s]
constexpr double kPitchError = 0.08;     // [rad]
constexpr double kTilt = 0.95;           // jumps onto platforms lean up to 0.9 [rad]

template <typename... Arguments>
std::string text(const char* format, Arguments... arguments) {
  char buffer[240];
  std::snprintf(buffer, sizeof buffer, format, arguments...);
  return buffer;
}

Clue found(Cause cause, const Sample& sample, std::string sentence) {
  return {.cause = cause,
          .time = sample.time,
          .jump = sample.jump,
          .unit = "",
          .sentence = std::move(sentence)};
}

Clue measured(Clue finding, double value, double limit, const char* unit) {
  finding.value = value;
  finding.limit = limit;
  finding.unit = unit;
  return finding;
}

bool in_contact(const Sample& sample) {
  return sample.load[0] > kTouch || sample.load[1] > kTouch;
}

/// Momentum that neither weight nor ground explains.
struct Unexplained {
  Eigen::Vector3d momentum = Eigen::Vector3d::Zero();  ///< [N·s]
  /// Of it, what the ground may have done unseen: between two records its force is known no better
  /// than it changed [N·s].
  Eigen::Vector3d doubt = Eigen::Vector3d::Zero();

  [[nodiscard]] double certain() const {
    return (momentum.cwiseAbs() - doubt).cwiseMax(0.0).norm();
  }
};

/// From sample `a` to `b`.
Unexplained unexplained(const Evidence& evidence, std::size_t a, std::size_t b) {
  Unexplained rest;
  rest.momentum = evidence.mass * (evidence.samples[b].v_WG - evidence.samples[a].v_WG);
  for (std::size_t i = a; i < b; ++i) {
    const Sample& from = evidence.samples[i];
    const Sample& to = evidence.samples[i + 1];
    const double dt = to.time - from.time;
    const Eigen::Vector3d before = from.ground[0].force + from.ground[1].force;
    const Eigen::Vector3d after = to.ground[0].force + to.ground[1].force;
    rest.momentum -= 0.5 * dt * (before + after);
    rest.doubt += 0.5 * dt * (after - before).cwiseAbs();
    rest.momentum.z() += evidence.mass * kGravity * dt;
  }
  return rest;
}

/// The whole of a push that shows between the samples `a` and `b`: from where it shows best until,
/// within one more window, there is no more of it.
Clue whole_push(const Evidence& evidence, std::size_t a, std::size_t b, double limit) {
  const std::vector<Sample>& samples = evidence.samples;
  const auto certain = [&](std::size_t from, std::size_t to) {
    return unexplained(evidence, from, to).certain();
  };
  std::size_t begin = a;
  for (std::size_t i = a + 1; i < b; ++i) {
    if (certain(i, b) >= certain(begin, b)) begin = i;
  }
  std::size_t end = b;
  for (std::size_t i = b + 1; i < samples.size(); ++i) {
    if (samples[i].time - samples[b].time > kPushWindow) break;
    if (certain(begin, i) > certain(begin, end)) end = i;
  }
  const Eigen::Vector3d impulse = unexplained(evidence, begin, end).momentum;
  return measured(
      found(Cause::push, samples[begin],
            text("something pushed the robot by (%.1f, %.1f, %.1f) N·s within %.2f s: "
                 "neither weight nor ground explains it",
                 impulse.x(), impulse.y(), impulse.z(), samples[end].time - samples[begin].time)),
      impulse.norm(), limit, "Ns");
}

std::optional<Clue> find_push(const Evidence& evidence) {
  if (!evidence.has_truth) return std::nullopt;
  std::size_t begin = 0;
  std::size_t in_air_since = 0;
  for (std::size_t i = 1; i < evidence.samples.size(); ++i) {
    const Sample& sample = evidence.samples[i];
    if (core::is_limp(sample.status.phase)) break;
    while (sample.time - evidence.samples[begin].time > kPushWindow) ++begin;
    if (in_contact(sample) || in_contact(evidence.samples[i - 1])) in_air_since = i;
    const std::size_t in_air = std::max(begin, in_air_since);
    if (unexplained(evidence, in_air, i).certain() > kPushInFlight) {
      return whole_push(evidence, in_air, i, kPushInFlight);
    }
    if (unexplained(evidence, begin, i).certain() > kPushOnGround) {
      return whole_push(evidence, begin, i, kPushOnGround);
    }
  }
  return std::nullopt;
}

std::optional<Clue> find_slip(const Evidence& evidence) {
  if (!evidence.has_truth) return std::nullopt;
  std::array<double, core::kLegs> path{};
  for (std::size_t i = 1; i < evidence.samples.size(); ++i) {
    const Sample& before = evidence.samples[i - 1];
    const Sample& sample = evidence.samples[i];
    if (core::is_limp(sample.status.phase)) break;
    const double dt = sample.time - before.time;
    for (std::size_t leg = 0; leg < core::kLegs; ++leg) {
      if (sample.load[leg] < kLoaded || before.load[leg] < kLoaded) {
        path[leg] = 0.0;
        continue;
      }
      // A foot that rolls over one tip keeps that tip in place.
      const double toe = (sample.toe[leg] - before.toe[leg]).head<2>().norm();
      const double heel = (sample.heel[leg] - before.heel[leg]).head<2>().norm();
      const double moved = std::min(toe, heel);
      if (moved > kSlipSpeed * dt) path[leg] += moved;
      if (path[leg] > kSlip) {
        return measured(
            found(Cause::slip, sample,
                  text("the %s sole slid %.0f mm under %.0f N while in %s",
                       leg == 0 ? "left" : "right", 1e3 * path[leg], sample.load[leg],
                       std::string(core::robot_phase_name(sample.status.phase)).c_str())),
            path[leg], kSlip, "m");
      }
    }
  }
  return std::nullopt;
}

std::optional<Clue> find_toe_catch(const Evidence& evidence) {
  if (!evidence.has_truth || !evidence.plan) return std::nullopt;
  for (const Sample& sample : evidence.samples) {
    const bool clear = sample.status.phase == RobotPhase::flight &&
                       sample.status.plan_time > evidence.plan->liftoff_time + kClearOfGround &&
                       sample.status.plan_time < evidence.plan->touchdown_time - kClearOfGround;
    if (!clear) continue;
    for (std::size_t leg = 0; leg < core::kLegs; ++leg) {
      const double force = sample.ground[leg].force.norm();
      if (force < kTouch) continue;
      return measured(
          found(
              Cause::toe_catch, sample,
              text("the %s foot touched something with %.0f N, %.2f s before the planned touchdown",
                   leg == 0 ? "left" : "right", force,
                   evidence.plan->touchdown_time - sample.status.plan_time)),
          force, kTouch, "N");
    }
  }
  return std::nullopt;
}

/// The first sample on the ground after the flight.
const Sample* touchdown_of(const Evidence& evidence) {
  bool flown = false;
  for (const Sample& sample : evidence.samples) {
    flown = flown || (sample.status.phase == RobotPhase::flight && !in_contact(sample));
    if (flown && in_contact(sample)) return &sample;
  }
  return nullptr;
}

/// When the plan expected the ground; `touch` if that never came.
const Sample& planned_touchdown(const Evidence& evidence, const Sample& touch) {
  for (const Sample& sample : evidence.samples) {
    if (sample.status.plan_time >= evidence.plan->touchdown_time) return sample;
  }
  return touch;
}

std::optional<Clue> find_terrain_height(const Evidence& evidence) {
  const Sample* touch = evidence.has_truth && evidence.plan ? touchdown_of(evidence) : nullptr;
  if (touch == nullptr) return std::nullopt;
  const std::size_t leg = touch->load[0] > touch->load[1] ? 0 : 1;
  const double ground = std::min(touch->toe[leg].z(), touch->heel[leg].z());
  const double planned = evidence.plan->target.p_WS.z() + evidence.plan->target.height;
  const double error = ground - planned;
  if (std::abs(error) < kHeightError) return std::nullopt;
  // Ground that is too low shows when the feet do not meet it in time.
  const Sample& when = error > 0.0 ? *touch : planned_touchdown(evidence, *touch);
  return measured(
      found(Cause::terrain_height, when,
            text("the ground was met %.0f mm %s than the plan was told (%.3f m, not "
                 "%.3f m)",
                 1e3 * std::abs(error), error > 0.0 ? "higher" : "lower", ground, planned)),
      error, kHeightError, "m");
}

std::optional<Clue> find_wrong_place(const Evidence& evidence) {
  const Sample* touch = evidence.has_truth && evidence.plan ? touchdown_of(evidence) : nullptr;
  if (touch == nullptr) return std::nullopt;
  const core::LandingTarget& target = evidence.plan->target;
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  Eigen::Vector3d wanted = Eigen::Vector3d::Zero();
  for (std::size_t leg = 0; leg < core::kLegs; ++leg) {
    middle += 0.25 * (touch->toe[leg] + touch->heel[leg]);
    wanted += 0.5 * target.X_WF[leg].translation();
  }
  const Eigen::Vector2d ahead(std::cos(target.heading), std::sin(target.heading));
  const Eigen::Vector2d error = (middle - wanted).head<2>();
  const double along = error.dot(ahead);
  const double across = ahead.x() * error.y() - ahead.y() * error.x();
  if (std::abs(across) > kPlaceError) {
    return measured(found(Cause::sideways, *touch,
                          text("landed %.0f mm to the %s of the target", 1e3 * std::abs(across),
                               across > 0.0 ? "left" : "right")),
                    across, kPlaceError, "m");
  }
  if (std::abs(along) < kPlaceError) return std::nullopt;
  return measured(found(along > 0.0 ? Cause::overshoot : Cause::undershoot, *touch,
                        text("landed %.0f mm %s of the target", 1e3 * std::abs(along),
                             along > 0.0 ? "ahead" : "short")),
                  along, kPlaceError, "m");
}

std::optional<Clue> find_takeoff_speed(const Evidence& evidence) {
  if (!evidence.has_truth || !evidence.plan || evidence.plan->knot_count == 0) return std::nullopt;
  const auto& knots = evidence.plan->knots;
  const auto* end = knots.begin() + static_cast<std::ptrdiff_t>(evidence.plan->knot_count);
  for (std::size_t i = 1; i < evidence.samples.size(); ++i) {
    const Sample& sample = evidence.samples[i];
    if (sample.status.phase != RobotPhase::flight || in_contact(sample)) continue;
    const auto* knot = std::find_if(knots.begin(), end, [&](const core::JumpKnot& k) {
      return k.time >= sample.status.plan_time;
    });
    if (knot == end) return std::nullopt;
    const double ahead = knot->time - sample.status.plan_time;
    const Eigen::Vector3d planned = knot->v_WG + Eigen::Vector3d(0.0, 0.0, kGravity * ahead);
    const Eigen::Vector3d error = sample.v_WG - planned;
    if (error.norm() < kTakeoffError) return std::nullopt;
    return measured(found(Cause::takeoff_speed, sample,
                          text("left the ground at (%.2f, %.2f, %.2f) m/s, planned (%.2f, %.2f, "
                               "%.2f) m/s",
                               sample.v_WG.x(), sample.v_WG.y(), sample.v_WG.z(), planned.x(),
                               planned.y(), planned.z())),
                    error.norm(), kTakeoffError, "m/s");
  }
  return std::nullopt;
}

std::optional<Clue> find_saturation(const Evidence& evidence) {
  std::array<double, core::kJoints> time{};
  for (std::size_t i = 1; i < evidence.samples.size(); ++i) {
    const Sample& sample = evidence.samples[i];
    if (core::is_limp(sample.status.phase)) break;
    const double dt = sample.time - evidence.samples[i - 1].time;
    for (std::size_t leg = 0; leg < core::kLegs; ++leg) {
      const auto at = static_cast<Eigen::Index>(leg * core::kJointsPerLeg);
      const model::MotorLoad load =
          model::motor_load(evidence.robot, sample.tau.segment<core::kJointsPerLeg>(at),
                            sample.truth.dq.segment<core::kJointsPerLeg>(at));
      for (Eigen::Index joint = 0; joint < static_cast<Eigen::Index>(core::kJointsPerLeg);
           ++joint) {
        const double most = std::max(load.torque_ratio[joint], load.power_ratio[joint]);
        double& total = time[static_cast<std::size_t>(at + joint)];
        if (most > kSaturated) total += dt;
        if (total < kSaturatedTime) continue;
        const bool torque = load.torque_ratio[joint] > load.power_ratio[joint];
        return measured(
            found(
                Cause::saturation, sample,
                text("the %s %s motor was at its %s limit for %.2f s", leg == 0 ? "left" : "right",
                     std::string(core::kJointNames[static_cast<std::size_t>(joint)]).c_str(),
                     torque ? "torque" : "power", total)),
            total, kSaturatedTime, "s");
      }
    }
  }
  return std::nullopt;
}

std::optional<Clue> find_estimator(const Evidence& evidence) {
  if (!evidence.has_truth) return std::nullopt;
  for (const Sample& sample : evidence.samples) {
    const double position = (sample.believed.p_WB - sample.truth.p_WB).norm();
    const double velocity = (sample.believed.v_WB - sample.truth.v_WB).norm();
    const double pitch = std::abs(model::rpy_from_rotation(sample.believed.R_WB).y() -
                                  model::rpy_from_rotation(sample.truth.R_WB).y());
    if (velocity > kVelocityError) {
      return measured(
          found(Cause::estimator, sample, text("the believed velocity was %.2f m/s off", velocity)),
          velocity, kVelocityError, "m/s");
    }
    if (position > kPositionError) {
      return measured(found(Cause::estimator, sample,
                            text("the believed position was %.0f mm off", 1e3 * position)),
                      position, kPositionError, "m");
    }
    if (pitch > kPitchError) {
      return measured(
          found(Cause::estimator, sample, text("the believed pitch was %.2f rad off", pitch)),
          pitch, kPitchError, "rad");
    }
  }
  return std::nullopt;
}

std::optional<Clue> find_contact(const Evidence& evidence) {
  if (!evidence.has_truth) return std::nullopt;
  std::array<double, core::kLegs> wrong{};
  for (std::size_t i = 1; i < evidence.samples.size(); ++i) {
    const Sample& sample = evidence.samples[i];
    const double dt = sample.time - evidence.samples[i - 1].time;
    for (std::size_t leg = 0; leg < core::kLegs; ++leg) {
      const bool differs = sample.believed.contact[leg] != sample.truth.contact[leg];
      wrong[leg] = differs ? wrong[leg] + dt : 0.0;
      if (wrong[leg] < kContactTime) continue;
      return measured(
          found(Cause::contact, sample,
                text("the %s foot was believed %s for %.0f ms while it was %s",
                     leg == 0 ? "left" : "right",
                     sample.believed.contact[leg] ? "on the ground" : "in the air",
                     1e3 * wrong[leg], sample.truth.contact[leg] ? "on the ground" : "in the air")),
          wrong[leg], kContactTime, "s");
    }
  }
  return std::nullopt;
}

std::optional<Clue> find_deadline(const Evidence& evidence) {
  for (std::size_t i = 1; i < evidence.samples.size(); ++i) {
    const int missed =
        evidence.samples[i].deadline_misses - evidence.samples[i - 1].deadline_misses;
    if (missed <= 0) continue;
    return measured(
        found(Cause::deadline, evidence.samples[i], text("%d ticks missed their deadline", missed)),
        missed, 0.0, "ticks");
  }
  return std::nullopt;
}

std::optional<Clue> find_tilt(const Evidence& evidence) {
  for (const Sample& sample : evidence.samples) {
    const double tilt = std::acos(std::clamp(sample.truth.R_WB(2, 2), -1.0, 1.0));
    if (!(tilt > kTilt)) continue;
    return measured(found(Cause::tilt, sample, text("the trunk leaned by %.2f rad", tilt)), tilt,
                    kTilt, "rad");
  }
  return std::nullopt;
}

}  // namespace

const std::vector<Detector>& detectors() {
  static const std::vector<Detector> all{find_push,           find_slip,        find_toe_catch,
                                         find_terrain_height, find_wrong_place, find_takeoff_speed,
                                         find_saturation,     find_estimator,   find_contact,
                                         find_deadline,       find_tilt};
  return all;
}

}  // namespace hopscotch::apps
