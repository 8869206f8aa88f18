#include "planner/warm_start.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "model/stand_posture.hpp"

namespace hopscotch::planner {

namespace {

using Vector = model::PlanarVector<double>;

// Typical of solved jumps; the solver only needs the neighbourhood.
constexpr double kPushTime = 0.30;             // [s]
constexpr double kLiftoffComAhead = 0.055;     // of the ankle [m]
constexpr double kLiftoffComHeight = 0.455;    // above the ankle [m]
constexpr double kLandingComAhead = -0.055;    // of the ankle [m]
constexpr double kLandingComHeight = 0.36;     // above the ankle [m]
constexpr double kFlightTime = 0.26;           // on level ground [s]
constexpr double kFlightTimePerHeight = 0.25;  // [s/m]
constexpr double kLiftoffPitch = 0.35;         // of the trunk [rad]
constexpr double kPitchPerHeight = -2.0;       // [rad/m]
constexpr double kLandingPitchShare = 0.5;     // of the lift-off pitch
constexpr double kComReach = 0.98;             // of the leg's longest span

/// A sagittal posture by where the CoM is from the ankle axis.
struct Pose {
  Vector com;
  double trunk = 0.0;
};

Pose blend(const Pose& from, const Pose& to, double s) {
  return {{from.com.x + s * (to.com.x - from.com.x), from.com.z + s * (to.com.z - from.com.z)},
          from.trunk + s * (to.trunk - from.trunk)};
}

/// 0 to 1 with zero rate at 0 and rate `end_rate` at 1 (cubic).
double ease(double s, double end_rate) {
  return s * s * ((3.0 - end_rate) + (end_rate - 2.0) * s);
}

/// Links of a pose; out of reach the CoM is drawn towards the ankle until it is in.
model::LinkArray<double> links(const PlanarModel& model, Pose pose) {
  const Pose nominal{{0.0, 0.33}, pose.trunk};
  for (int attempt = 0; attempt < 20; ++attempt) {
    const auto found = model::links_from_com(model.dynamics, pose.com, {0.0, 0.0, 0.0, pose.trunk});
    if (found) return *found;
    pose = blend(nominal, pose, 0.9);
  }
  return {0.0, -0.75, 0.75, pose.trunk};
}

struct Phases {
  std::vector<model::LinkArray<double>> takeoff;
  std::vector<model::LinkArray<double>> flight;
  std::vector<model::LinkArray<double>> landing;
};

/// The parabola between lift-off and touchdown CoM.
struct Parabola {
  Vector from;
  Vector velocity;
  double time = 0.0;
  [[nodiscard]] Vector at(double t) const {
    return {from.x + velocity.x * t, from.z + velocity.z * t - 0.5 * model::kGravity * t * t};
  }
};

struct Sketch {
  Pose start;
  Pose liftoff;
  Pose touchdown;
  Pose end;
  Vector start_ankle;
  Vector target_ankle;
  Parabola parabola;
};

Pose pose_of(const PlanarModel& model, const model::LinkArray<double>& a) {
  return {model.dynamics.com(a), a[model::kTrunk]};
}

Sketch sketch(const PlanarModel& model, const PlanarTask& task) {
  const double sole = model.dynamics.chain().sole_height;
  Sketch s;
  s.start = pose_of(model, task.start.pitch);
  s.end = pose_of(model, task.final_posture);
  const double pitch = std::clamp(kLiftoffPitch + kPitchPerHeight * task.height,
                                  model.config.trunk_pitch_min, model.config.trunk_pitch_max);
  s.liftoff = {{kLiftoffComAhead, kLiftoffComHeight - sole}, pitch};
  s.touchdown = {{kLandingComAhead, kLandingComHeight}, kLandingPitchShare * pitch};
  s.liftoff.com = model.dynamics.com(links(model, s.liftoff));
  s.touchdown.com = model.dynamics.com(links(model, s.touchdown));
  s.start_ankle = {model.ankle_x(), sole};
  s.target_ankle = {task.distance + model.ankle_x(), task.height + sole};
  Parabola& arc = s.parabola;
  arc.time = kFlightTime + kFlightTimePerHeight * std::abs(task.height);
  arc.from = {s.start_ankle.x + s.liftoff.com.x, s.start_ankle.z + s.liftoff.com.z};
  const Vector to{s.target_ankle.x + s.touchdown.com.x, s.target_ankle.z + s.touchdown.com.z};
  arc.velocity = {(to.x - arc.from.x) / arc.time,
                  (to.z - arc.from.z) / arc.time + 0.5 * model::kGravity * arc.time};
  return s;
}

std::vector<model::LinkArray<double>> takeoff_links(const PlanarModel& model, const Sketch& s,
                                                    const StepCounts& steps) {
  std::vector<model::LinkArray<double>> out;
  const double total = model.config.takeoff_time();
  const double push = std::min(kPushTime, total);
  const double rise = s.liftoff.com.z - s.start.com.z;
  const double end_rate = std::clamp(s.parabola.velocity.z * push / std::max(rise, 0.03), 1.0, 3.0);
  double t = push - total;  // since the push began
  for (int k = 0; k <= steps.takeoff; ++k) {
    const double share = std::clamp(t / push, 0.0, 1.0);
    out.push_back(links(model, blend(s.start, s.liftoff, ease(share, end_rate))));
    if (k < steps.takeoff) t += model.config.takeoff_step(k);
  }
  return out;
}

std::vector<model::LinkArray<double>> flight_links(const PlanarModel& model, const PlanarTask& task,
                                                   const Sketch& s, const StepCounts& steps) {
  std::vector<model::LinkArray<double>> out;
  const double rise = std::max(0.0, task.height);
  for (int k = 0; k <= steps.flight; ++k) {
    const double share = static_cast<double>(k) / steps.flight;
    const Vector com = s.parabola.at(share * s.parabola.time);
    const double along = ease(share, 0.0);
    const double up = ease(std::min(1.0, 1.6 * share), 0.0);
    const double wave = std::sin(std::numbers::pi * share);
    const Vector ankle{s.start_ankle.x + along * (s.target_ankle.x - s.start_ankle.x),
                       s.start_ankle.z + (task.height > 0.0 ? up * rise : along * task.height) +
                           1.2 * task.clearance * wave * wave};
    const double trunk = s.liftoff.trunk + share * (s.touchdown.trunk - s.liftoff.trunk);
    out.push_back(links(model, {{com.x - ankle.x, com.z - ankle.z}, trunk}));
  }
  return out;
}

std::vector<model::LinkArray<double>> landing_links(const PlanarModel& model, const Sketch& s,
                                                    const StepCounts& steps) {
  std::vector<model::LinkArray<double>> out;
  double share = 0.0;  // of the landing's duration
  for (int k = 0; k <= steps.landing; ++k) {
    const double left = (1.0 - share) * (1.0 - share);
    out.push_back(links(model, blend(s.end, s.touchdown, left)));
    if (k < steps.landing) share += model.config.landing_share(k) / steps.landing;
  }
  return out;
}

/// Rates by central differences; at rest where `ends_at_rest`.
model::LinkArray<double> rate(const std::vector<model::LinkArray<double>>& path, int k, double dt) {
  const int last = static_cast<int>(path.size()) - 1;
  const int a = std::max(0, k - 1);
  const int b = std::min(last, k + 1);
  model::LinkArray<double> out{};
  for (std::size_t j = 0; j < model::kPlanarLinks; ++j) {
    out[j] = (path[static_cast<std::size_t>(b)][j] - path[static_cast<std::size_t>(a)][j]) /
             ((b - a) * dt);
  }
  return out;
}

void put(const model::LinkArray<double>& link, int at, int count, Eigen::VectorXd& x) {
  const std::array<double, kFlightDof> y = coordinates_from_links(link);
  for (int d = 0; d < count; ++d) x(at + d) = y[static_cast<std::size_t>(d)];
}

}  // namespace

Eigen::VectorXd kinematic_guess(const PlanarModel& model, const PlanarTask& task,
                                const DecisionLayout& layout) {
  const StepCounts& steps = layout.steps();
  const Sketch s = sketch(model, task);
  const Phases phases{takeoff_links(model, s, steps), flight_links(model, task, s, steps),
                      landing_links(model, s, steps)};
  const double flight_step = s.parabola.time / steps.flight;
  const double landing_step = model.config.landing_step_longest(task.distance, task.height);
  Eigen::VectorXd x = Eigen::VectorXd::Zero(layout.size());
  for (int k = 0; k <= steps.takeoff; ++k) {
    const auto& a = phases.takeoff[static_cast<std::size_t>(k)];
    put(a, layout.takeoff(k), kStanceDof, x);
    put(rate(phases.takeoff, k, model.config.takeoff_step(std::min(k, steps.takeoff - 1))),
        layout.takeoff(k) + kStanceDof, kStanceDof, x);
  }
  for (int k = 1; k <= steps.flight; ++k) {
    put(phases.flight[static_cast<std::size_t>(k)], layout.flight(k), kFlightDof, x);
    put(rate(phases.flight, k, flight_step), layout.flight(k) + kFlightDof, kFlightDof, x);
  }
  put(rate(phases.landing, 0, landing_step * model.config.landing_share(0)),
      layout.touchdown_rates(), kStanceDof, x);
  for (int k = 1; k <= steps.landing; ++k) {
    put(phases.landing[static_cast<std::size_t>(k)], layout.landing(k), kStanceDof, x);
    const double step = landing_step * model.config.landing_share(std::min(k, steps.landing - 1));
    put(rate(phases.landing, k, step), layout.landing(k) + kStanceDof, kStanceDof, x);
  }
  x(layout.liftoff_com()) = s.parabola.from.x;
  x(layout.liftoff_com() + 1) = s.parabola.from.z;
  x(layout.liftoff_velocity()) = s.parabola.velocity.x;
  x(layout.liftoff_velocity() + 1) = s.parabola.velocity.z;
  const std::size_t last = phases.takeoff.size() - 1;
  x(layout.momentum()) = model.dynamics.centroidal_momentum(
      phases.takeoff[last], rate(phases.takeoff, steps.takeoff, model.config.takeoff_last_step));
  x(layout.flight_step()) = flight_step;
  x(layout.landing_step()) = landing_step;
  return x;
}

}  // namespace hopscotch::planner
