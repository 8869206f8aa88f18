#include "control/qp_solver.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstddef>

#include "control/qp_solver_interior_point.hpp"

namespace hopscotch::control {

namespace {

using riccati::InputTable;
using riccati::kInputs;
using riccati::kLanes;
using riccati::kRows;
using riccati::kState;
using riccati::kTop;
using riccati::kWrench;
using riccati::RowTable;

constexpr double kColdForceShare = 0.25;  ///< Cold start: Fz as a share of its bound.
/// Cold start: slack times multiplier of a row, as a share of top * largest gradient.
constexpr double kColdCentring = 0.00375;
/// Warm start: share of the previous wrench. The rest is the cold start's, which is well inside.
constexpr double kWarmShare = 0.7;
constexpr double kWarmCentring = 1e-3;  ///< Warm start: least slack times multiplier of a row.

/// Position of a component of a FootInput among the inputs of a step.
constexpr int input_index(int foot, int component) {
  return component == kForceZ ? kLanes + foot : 4 * foot + component;
}

/// Position of the paper's state component i in the recursion's order [v w p rpy].
constexpr int state_index(int i) {
  return (i + kWrench) % kState;
}

bool positive(double value) {
  return std::isfinite(value) && value > 0.0;
}

bool foot_is_valid(const WrenchQpFoot& foot) {
  return !foot.contact || (foot.p_GF.allFinite() && foot.R_force.allFinite() &&
                           foot.R_moment.allFinite() && foot.reference.allFinite());
}

bool stage_is_valid(const WrenchQpStage& stage) {
  return positive(stage.dt) && stage.rpy_rate.allFinite() && stage.inertia_inverse.allFinite() &&
         stage.velocity_gain.allFinite() && stage.target.allFinite() &&
         foot_is_valid(stage.feet[0]) && foot_is_valid(stage.feet[1]);
}

bool problem_is_valid(const WrenchQp& qp) {
  if (qp.horizon < 1 || qp.horizon > WrenchQp::kMaxHorizon || !positive(qp.mass) ||
      !qp.x0.allFinite() || !qp.state_weight.allFinite() || !qp.input_weight.allFinite()) {
    return false;
  }
  const bool weights = (qp.state_weight.array() >= 0.0).all() &&
                       (qp.state_weight.tail<6>().array() > 0.0).all() &&
                       (qp.input_weight.array() >= WrenchQp::kMinInputWeight).all();
  const bool cone = !qp.cone.upper.isNaN().any() && !qp.cone.lower.isNaN().any() &&
                    std::isfinite(qp.cone.max_normal_force);
  return weights && cone &&
         std::all_of(qp.stages.begin(), qp.stages.begin() + qp.horizon, stage_is_valid);
}

bool cone_has_interior(const WrenchCone& cone) {
  return (cone.upper + cone.lower > 0.0).all() && cone.max_normal_force > 0.0;
}

riccati::Drift drift_of(const WrenchQpStage& stage, double time) {
  riccati::Drift drift;
  drift.time = time;
  for (int j = 0; j < 3; ++j) {
    for (int i = 0; i < 3; ++i) {
      drift.rate[j][i] = drift.padded[i][3 + j] = time * stage.rpy_rate(i, j);
    }
  }
  return drift;
}

/// What a unit of one component of a foot's wrench adds to the velocities in one step.
Eigen::Vector<double, kWrench> column_of(const WrenchQpStage& stage, const WrenchQpFoot& foot,
                                         int component, double mass) {
  Eigen::Vector<double, kWrench> column = Eigen::Vector<double, kWrench>::Zero();
  if (!foot.contact) return column;
  if (component == kMomentY || component == kMomentZ) {
    const int axis = component == kMomentY ? 1 : 2;
    column.tail<3>() = stage.dt * (stage.inertia_inverse * foot.R_moment.col(axis));
    return column;
  }
  const Eigen::Vector3d force = foot.R_force.col(component == kForceZ ? 2 : component);
  column.head<3>() = stage.dt / mass * force;
  column.tail<3>() = stage.dt * (stage.inertia_inverse * foot.p_GF.cross(force));
  return column;
}

}  // namespace

struct QpSolver::Workspace {
  explicit Workspace(const QpTolerances& t) : tolerances(t) {}

  QpTolerances tolerances;
  riccati::InteriorPoint point;
  alignas(16) InputTable gradient{};

  // The previous problem's solution, for the warm start.
  alignas(16) InputTable old_input{};
  alignas(16) RowTable old_multiplier{};
  alignas(16) RowTable old_active{};
  int old_steps = 0;

  bool usable = false;  ///< The iterate solves the problem in `point`.
  bool warm = false;
  int iterations = 0;
  double gap = 0.0;
  double stationarity = 0.0;
  double cost = 0.0;

  void load(const WrenchQp& qp) noexcept;
  void load_cone(const WrenchQp& qp) noexcept;
  void load_step(const WrenchQp& qp, int k) noexcept;
  void start_inputs() noexcept;
  void start_multipliers() noexcept;
  void keep_solution() noexcept;
  void blend_inputs(const WarmStartMap& map) noexcept;
  void blend_multipliers(const WarmStartMap& map) noexcept;
  [[nodiscard]] bool foot_is_continued(int old_step, int k, int foot) const noexcept;
  QpStatus iterate() noexcept;
};

void QpSolver::Workspace::load(const WrenchQp& qp) noexcept {
  point.sweep.steps = qp.horizon;
  for (int i = 0; i < kState; ++i) {
    point.sweep.state_weight[state_index(i)] = qp.state_weight(i);
    point.x0[state_index(i)] = qp.x0(i);
  }
  load_cone(qp);
  for (int k = 0; k < qp.horizon; ++k) load_step(qp, k);
}

void QpSolver::Workspace::load_cone(const WrenchQp& qp) noexcept {
  for (int foot = 0; foot < core::kLegs; ++foot) {
    for (int i = 0; i < 4; ++i) {
      const double upper = qp.cone.upper(i);
      const double lower = qp.cone.lower(i);
      point.bound[4 * foot + i] = std::isfinite(upper) ? upper : 0.0;
      point.bound[kLanes + 4 * foot + i] = std::isfinite(lower) ? lower : 0.0;
    }
    for (int i = 0; i < 5; ++i) point.input_weight[input_index(foot, i)] = qp.input_weight(i);
  }
  point.top = qp.cone.max_normal_force;
}

void QpSolver::Workspace::load_step(const WrenchQp& qp, int k) noexcept {
  const WrenchQpStage& stage = qp.stages[static_cast<std::size_t>(k)];
  riccati::Step& step = point.sweep.step[k];
  const double after = qp.rule == StepRule::zero_order_hold ? 0.5 * stage.dt : 0.0;
  step.before = drift_of(stage, stage.dt - after);
  step.after = drift_of(stage, after);
  step.contact = stage.feet[0].contact || stage.feet[1].contact;
  for (int i = 0; i < kState; ++i) point.target[k][state_index(i)] = stage.target(i);
  for (int i = 0; i < kWrench; ++i) point.velocity_gain[k][i] = stage.velocity_gain(i);

  for (int leg = 0; leg < core::kLegs; ++leg) {
    const WrenchQpFoot& foot = stage.feet[static_cast<std::size_t>(leg)];
    for (int component = 0; component < 5; ++component) {
      const int i = input_index(leg, component);
      const Eigen::Vector<double, kWrench> column = column_of(stage, foot, component, qp.mass);
      for (int j = 0; j < kWrench; ++j) step.rows[j][i] = step.columns[i][j] = column(j);
      point.reference[k][i] = foot.contact ? foot.reference(component) : 0.0;
    }
    for (int i = 0; i < 4; ++i) {
      point.active[k][4 * leg + i] = foot.contact && std::isfinite(qp.cone.upper(i)) ? 1.0 : 0.0;
      point.active[k][kLanes + 4 * leg + i] =
          foot.contact && std::isfinite(qp.cone.lower(i)) ? 1.0 : 0.0;
    }
    point.active[k][kTop + leg] = foot.contact ? 1.0 : 0.0;
  }
}

/// A quarter of the greatest normal force, the other components in the middle of their range.
void QpSolver::Workspace::start_inputs() noexcept {
  for (int k = 0; k < point.sweep.steps; ++k) {
    for (int i = 0; i < kInputs; ++i) {
      const int foot = i < kLanes ? i / 4 : i - kLanes;
      const double normal = kColdForceShare * point.top * point.active[k][kTop + foot];
      const bool bounded =
          i < kLanes && point.active[k][i] > 0.0 && point.active[k][kLanes + i] > 0.0;
      point.input[k][i] = i >= kLanes ? normal
                          : bounded   ? 0.5 * (point.bound[i] - point.bound[kLanes + i]) * normal
                                      : 0.0;
    }
  }
}

/// Multipliers of equal complementarity, in proportion to what the cost pulls with.
void QpSolver::Workspace::start_multipliers() noexcept {
  double pull = 0.0;
  double count = 0.0;
  for (int k = 0; k < point.sweep.steps; ++k) {
    for (int foot = 0; foot < core::kLegs; ++foot) {
      const double contact = point.active[k][kTop + foot];
      pull += contact * std::abs(gradient[k][kLanes + foot]);
      count += contact;
    }
  }
  const double product = std::max(kColdCentring * point.top * pull / std::max(count, 1.0), 1e-6);
  for (int k = 0; k < point.sweep.steps; ++k) {
    for (int i = 0; i < kRows; ++i) {
      point.multiplier[k][i] = point.active[k][i] > 0.0 ? product / point.slack[k][i] : 1.0;
    }
  }
}

void QpSolver::Workspace::keep_solution() noexcept {
  old_steps = point.sweep.steps;
  std::copy_n(&point.input[0][0], old_steps * kInputs, &old_input[0][0]);
  std::copy_n(&point.multiplier[0][0], old_steps * kRows, &old_multiplier[0][0]);
  std::copy_n(&point.active[0][0], old_steps * kRows, &old_active[0][0]);
}

/// A foot's wrench can be carried over only from a step in which it stood.
bool QpSolver::Workspace::foot_is_continued(int old_step, int k, int foot) const noexcept {
  return old_step >= 0 && old_step < old_steps && old_active[old_step][kTop + foot] > 0.0 &&
         point.active[k][kTop + foot] > 0.0;
}

/// `point.input` holds the cold start.
void QpSolver::Workspace::blend_inputs(const WarmStartMap& map) noexcept {
  for (int k = 0; k < point.sweep.steps; ++k) {
    const int old_step = map[static_cast<std::size_t>(k)];
    for (int i = 0; i < kInputs; ++i) {
      const int foot = i < kLanes ? i / 4 : i - kLanes;
      if (!foot_is_continued(old_step, k, foot)) continue;
      point.input[k][i] =
          kWarmShare * old_input[old_step][i] + (1.0 - kWarmShare) * point.input[k][i];
    }
  }
}

/// `point.multiplier` holds the cold start.
void QpSolver::Workspace::blend_multipliers(const WarmStartMap& map) noexcept {
  for (int k = 0; k < point.sweep.steps; ++k) {
    const int old_step = map[static_cast<std::size_t>(k)];
    for (int i = 0; i < kRows; ++i) {
      const int foot = i < kTop ? (i % kLanes) / 4 : i - kTop;
      if (!foot_is_continued(old_step, k, foot) || point.active[k][i] == 0.0) continue;
      point.multiplier[k][i] =
          std::max(old_multiplier[old_step][i], kWarmCentring / point.slack[k][i]);
    }
  }
}

QpStatus QpSolver::Workspace::iterate() noexcept {
  double scale = 0.0;
  for (int k = 0; k < point.sweep.steps; ++k) {
    for (const double g : gradient[k]) scale = std::max(scale, std::abs(g));
  }
  stationarity = scale > 0.0 ? point.lagrangian_gradient(gradient) / scale : 0.0;
  usable = false;
  for (iterations = 0;; ++iterations) {
    const riccati::InteriorPoint::Measure now = point.measure();
    cost = now.cost;
    if (!std::isfinite(cost)) return QpStatus::iteration_limit;
    gap = 2.0 * now.complementarity / (1.0 + 2.0 * now.cost);
    usable = gap <= tolerances.gap && stationarity <= tolerances.stationarity;
    if (usable) return QpStatus::solved;
    if (iterations >= tolerances.iteration_cap) return QpStatus::iteration_limit;
    const double length = point.advance_iterate(now.complementarity);
    if (std::isnan(length)) return QpStatus::iteration_limit;
    stationarity *= 1.0 - length;  // exact, since the residual is linear in the iterate
  }
}

QpSolver::QpSolver(const QpTolerances& tolerances)
    : workspace_(std::make_unique<Workspace>(tolerances)) {}
QpSolver::~QpSolver() = default;
QpSolver::QpSolver(QpSolver&&) noexcept = default;
QpSolver& QpSolver::operator=(QpSolver&&) noexcept = default;

QpStatus QpSolver::solve_cold(const WrenchQp& qp) noexcept {
  WarmStartMap nothing;
  nothing.fill(-1);
  return solve_warm(qp, nothing);
}

QpStatus QpSolver::solve_warm(const WrenchQp& qp, const WarmStartMap& map) noexcept {
  if (!problem_is_valid(qp)) return QpStatus::bad_input;
  if (!cone_has_interior(qp.cone)) return QpStatus::infeasible;
  Workspace& w = *workspace_;
  w.warm = w.usable &&
           std::any_of(map.begin(), map.begin() + qp.horizon, [](int step) { return step >= 0; });
  if (w.warm) w.keep_solution();
  w.load(qp);
  w.start_inputs();
  if (w.warm) w.blend_inputs(map);
  w.point.roll_out();
  w.point.cost_gradient(w.gradient);
  w.start_multipliers();
  if (w.warm) w.blend_multipliers(map);
  return w.iterate();
}

FootInput QpSolver::input(int step, core::Leg leg) const noexcept {
  FootInput result;
  for (int i = 0; i < 5; ++i) {
    result(i) = workspace_->point.input[step][input_index(static_cast<int>(core::index(leg)), i)];
  }
  return result;
}

ConeMultipliers QpSolver::multipliers(int step, core::Leg leg) const noexcept {
  const riccati::InteriorPoint& point = workspace_->point;
  const int foot = static_cast<int>(core::index(leg));
  const auto doubled = [&](int row) {  // the recursion minimises half of the cost
    return 2.0 * point.active[step][row] * point.multiplier[step][row];
  };
  ConeMultipliers result;
  for (int i = 0; i < 4; ++i) {
    result.upper(i) = doubled(4 * foot + i);
    result.lower(i) = doubled(kLanes + 4 * foot + i);
  }
  result.top = doubled(kTop + foot);
  return result;
}

BodyState QpSolver::state(int knot) const noexcept {
  const riccati::InteriorPoint& point = workspace_->point;
  BodyState result;
  for (int i = 0; i < kState; ++i) {
    result(i) = point.error[knot - 1][state_index(i)] + point.target[knot - 1][state_index(i)];
  }
  return result;
}

double QpSolver::objective() const noexcept {
  return 2.0 * workspace_->cost;
}
int QpSolver::iterations() const noexcept {
  return workspace_->iterations;
}
double QpSolver::gap() const noexcept {
  return workspace_->gap;
}
double QpSolver::stationarity() const noexcept {
  return workspace_->stationarity;
}
bool QpSolver::started_warm() const noexcept {
  return workspace_->warm;
}

}  // namespace hopscotch::control
