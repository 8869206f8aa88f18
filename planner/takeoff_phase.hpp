#pragma once

#include <memory>
#include <vector>

#include "planner/constraint_block.hpp"
#include "planner/objective.hpp"
#include "planner/planar_jump.hpp"
#include "planner/shared_limits.hpp"
#include "planner/step_shift.hpp"

namespace hopscotch::planner {

using BlockList = std::vector<std::unique_ptr<ConstraintBlock>>;

/// Change of the rates over half a step of length `h` with accelerations `u`.
template <typename T>
[[nodiscard]] model::LinkArray<T> half_change(const model::LinkArray<T>& u, const T& h) {
  const T half = 0.5 * h;
  return {half * u[0], half * u[1], half * u[2], half * u[3]};
}

/// One step with flat fixed feet: the three-link dynamics of eq. (10a) with every limit of eq. (9)
/// that involves forces, at the mid-point. Serves takeoff and landing.
struct StanceLaw {
  static constexpr int kRows = MotorRows::kRows + GroundRows::kRows;
  model::PlanarDynamics dynamics;
  MotorRows motors;
  GroundRows ground;
  StepObjective objective;

  template <typename T>
  T operator()(const std::array<T, 10>& x, std::array<T, kRows>& rows) const {
    const T zero = T(0.0);
    const model::LinkArray<T> a = links_from_coordinates(x[0], x[1], x[2], zero);
    const model::LinkArray<T> w = links_from_coordinates(x[3], x[4], x[5], zero);
    const model::LinkArray<T> u = links_from_coordinates(x[6], x[7], x[8], zero);
    const model::StanceLoads<T> loads = dynamics.stance_loads(a, w, u);
    motors.write(loads.tau, w, half_change(u, x[9]), rows.data());
    ground.write(loads, rows.data() + MotorRows::kRows);
    return objective(a, w, u, loads.tau);
  }
  void bounds(std::span<double> lower, std::span<double> upper) const {
    motors.bounds(lower.first(MotorRows::kRows), upper.first(MotorRows::kRows));
    ground.bounds(lower.subspan(MotorRows::kRows), upper.subspan(MotorRows::kRows));
  }
};

/// How far a shank of radius `radius` [m], on a foot that stands with its ankle axis at `ankle`, is
/// above the terrain where it comes nearest to it; less than zero inside of it [m].
[[nodiscard]] double shank_room(const PlanarModel& model, const SmoothTerrain& terrain,
                                const model::PlanarVector<double>& ankle, double pitch,
                                double radius);

/// Range of shank pitches for which shank and knee, on a foot that stands with its ankle axis at
/// `ankle`, keep their clearance from the terrain; at most the configured one.
struct ShankRange {
  double lower = 0.0;  ///< [rad]
  double upper = 0.0;  ///< [rad]
};
[[nodiscard]] ShankRange shank_range(const PlanarModel& model, const SmoothTerrain& terrain,
                                     const model::PlanarVector<double>& ankle);

/// The law of takeoff step `k`.
[[nodiscard]] StanceLaw takeoff_law(const PlanarModel& model, const PlanarTask& task, int k);

/// The smoothness of takeoff steps `k` and `k` + 1.
[[nodiscard]] SmoothnessLaw smoothness_law(const PlannerConfig& config, int k);

/// Cost on the change of acceleration between takeoff steps.
void add_smoothness(const PlanarModel& model, const DecisionLayout& layout, BlockList& blocks);

/// Eq. (10): steps of the takeoff, and the joint limits of its knots.
void add_takeoff(const PlanarModel& model, const PlanarTask& task, const DecisionLayout& layout,
                 BlockList& blocks, StepCorrections corrections = {});

}  // namespace hopscotch::planner
