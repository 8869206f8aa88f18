#include "control/wrench_mpc.hpp"

#include <array>
#include <cstddef>

#include "control/wrench_mpc_problem.hpp"

namespace hopscotch::control {

namespace {

constexpr MpcStatus mpc_status(QpStatus status) {
  switch (status) {
    case QpStatus::solved: return MpcStatus::solved;
    case QpStatus::iteration_limit: return MpcStatus::iteration_limit;
    case QpStatus::infeasible: return MpcStatus::infeasible;
    case QpStatus::bad_input: return MpcStatus::bad_input;
  }
  return MpcStatus::bad_input;
}

}  // namespace

struct WrenchMpc::Workspace {
  Workspace(const WrenchMpcConfig& c, const model::RobotParameters& r)
      : horizon(c.horizon), robot(r), qp(constant_part(c, r)), solver(c.tolerances) {}

  int horizon;
  model::RobotParameters robot;
  WrenchQp qp;
  WarmStartMap start_map{};  // of `qp`
  QpSolver solver;
  MpcStatistics statistics;

  // The window of the previous solve, to find its wrenches again by absolute time.
  core::Stamp old_stamp;
  MpcForm old_form = MpcForm::full;
  std::size_t old_horizon = 0;
  std::array<double, core::ControlReference::kMaxHorizon> old_step_end{};  ///< After it [s].

  [[nodiscard]] WarmStartMap map_to_previous(const core::ControlReference& reference,
                                             MpcForm form) const noexcept;
  void remember_window(const core::ControlReference& reference, MpcForm form) noexcept;
};

/// For each step the previous step that covers its middle; behind the previous window, its last.
WarmStartMap WrenchMpc::Workspace::map_to_previous(const core::ControlReference& reference,
                                                   MpcForm form) const noexcept {
  WarmStartMap map;
  map.fill(-1);
  if (old_horizon == 0 || form != old_form) return map;
  double start = reference.stamp.since(old_stamp);
  std::size_t old_step = 0;
  for (std::size_t k = 0; k < reference.horizon; ++k) {
    const double middle = start + 0.5 * reference.knots[k].dt;
    while (old_step + 1 < old_horizon && old_step_end[old_step] < middle) ++old_step;
    map[k] = static_cast<int>(old_step);
    start += reference.knots[k].dt;
  }
  return map;
}

void WrenchMpc::Workspace::remember_window(const core::ControlReference& reference,
                                           MpcForm form) noexcept {
  old_stamp = reference.stamp;
  old_form = form;
  old_horizon = reference.horizon;
  double end = 0.0;
  for (std::size_t k = 0; k < reference.horizon; ++k) {
    end += reference.knots[k].dt;
    old_step_end[k] = end;
  }
}

WrenchMpc::WrenchMpc(const WrenchMpcConfig& config, const model::RobotParameters& robot)
    : workspace_(std::make_unique<Workspace>(config, robot)) {}
WrenchMpc::~WrenchMpc() = default;
WrenchMpc::WrenchMpc(WrenchMpc&&) noexcept = default;
WrenchMpc& WrenchMpc::operator=(WrenchMpc&&) noexcept = default;

MpcStatus WrenchMpc::solve(const core::RobotState& state, const core::ControlReference& reference,
                           MpcForm form, core::ContactWrenches& wrenches) noexcept {
  Workspace& w = *workspace_;
  if (!can_pose(state, reference, w.horizon)) return MpcStatus::bad_input;
  pose_problem(w.robot, state, reference, form, w.qp);
  w.start_map = w.map_to_previous(reference, form);
  const QpStatus status = w.solver.solve_warm(w.qp, w.start_map);
  if (status == QpStatus::bad_input || status == QpStatus::infeasible) return mpc_status(status);
  w.remember_window(reference, form);
  w.statistics = {w.solver.iterations(), w.solver.started_warm(), w.solver.gap(),
                  w.solver.stationarity()};
  if (status != QpStatus::solved) return mpc_status(status);
  for (const core::Leg leg : core::kAllLegs) {
    const std::size_t i = core::index(leg);
    wrenches[i] = reference.knots[0].contact[i]
                      ? foot_wrench(w.solver.input(0, leg), reference.knots[0].rpy.z())
                      : core::Wrench{};
  }
  return MpcStatus::solved;
}

const MpcStatistics& WrenchMpc::statistics() const noexcept {
  return workspace_->statistics;
}
const WrenchQp& WrenchMpc::qp() const noexcept {
  return workspace_->qp;
}
const WarmStartMap& WrenchMpc::warm_start_map() const noexcept {
  return workspace_->start_map;
}
const QpSolver& WrenchMpc::solver() const noexcept {
  return workspace_->solver;
}

}  // namespace hopscotch::control
