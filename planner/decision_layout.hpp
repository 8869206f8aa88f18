#pragma once

#include <array>

#include "model/planar_dynamics.hpp"

namespace hopscotch::planner {

/// Number of steps of each phase. Without a flight there is no takeoff either: what is left of a
/// jump that is down is a landing that starts in stance.
struct StepCounts {
  int takeoff = 0;
  int flight = 0;
  int landing = 0;

  [[nodiscard]] bool landed() const { return flight == 0; }
};

/// Coordinates of the legs and trunk at a knot. The knee is relative, so that its range and speed
/// are plain bounds; the others are absolute pitches. The foot moves in flight only.
inline constexpr int kShankPitch = 0;
inline constexpr int kKneeAngle = 1;
inline constexpr int kTrunkPitch = 2;
inline constexpr int kFootPitch = 3;
inline constexpr int kStanceDof = 3;
inline constexpr int kFlightDof = 4;

/// Links (pitches, rates or accelerations) from coordinates; `foot` is zero in stance.
template <typename T>
[[nodiscard]] model::LinkArray<T> links_from_coordinates(const T& shank, const T& knee,
                                                         const T& trunk, const T& foot) {
  return {foot, shank, shank - knee, trunk};
}
[[nodiscard]] inline std::array<double, kFlightDof> coordinates_from_links(
    const model::LinkArray<double>& link) {
  return {link[model::kShank], link[model::kShank] - link[model::kThigh], link[model::kTrunk],
          link[model::kFoot]};
}

/// Who lives where in the decision vector, eq. (7). Per knot only coordinates y and rates v: joint
/// torques, ground force and moment are explicit functions of two neighbouring knots, so they are
/// rows, not variables. The last takeoff knot is the first flight knot; the last flight knot and
/// the first landing knot share y, not v (touchdown). Of a jump that is down, only landing knots
/// from 0 on and dt^l are there.
class DecisionLayout {
 public:
  explicit DecisionLayout(const StepCounts& steps) : steps_(steps) {}

  [[nodiscard]] const StepCounts& steps() const { return steps_; }
  [[nodiscard]] int size() const { return landing_step() + 1; }

  /// Takeoff knot 0 to `takeoff`: y at +0, v at +3.
  [[nodiscard]] int takeoff(int knot) const { return kStanceSize * knot; }
  /// Flight knot 1 to `flight`: y at +0, v at +4.
  [[nodiscard]] int flight(int knot) const {
    return takeoff(steps_.takeoff + 1) + kFlightSize * (knot - 1);
  }
  /// Rates of the first landing knot, 3 numbers; its y is that of the last flight knot.
  [[nodiscard]] int touchdown_rates() const { return flight(steps_.flight + 1); }
  /// Landing knot 1, if landed 0, to `landing`: y at +0, v at +3.
  [[nodiscard]] int landing(int knot) const {
    if (steps_.landed()) return kStanceSize * knot;
    return touchdown_rates() + kStanceDof + kStanceSize * (knot - 1);
  }
  /// Whole-body CoM at lift-off in S: x, z [m].
  [[nodiscard]] int liftoff_com() const { return landing(steps_.landing + 1); }
  /// Its velocity: x, z [m/s].
  [[nodiscard]] int liftoff_velocity() const { return liftoff_com() + 2; }
  /// Centroidal angular momentum of the flight [kg·m^2/s].
  [[nodiscard]] int momentum() const { return liftoff_com() + 4; }
  /// Step lengths dt^f and dt^l [s].
  [[nodiscard]] int flight_step() const { return liftoff_com() + 5; }
  [[nodiscard]] int landing_step() const {
    return steps_.landed() ? landing(steps_.landing + 1) : liftoff_com() + 6;
  }

  /// Both ends of takeoff step `k`: y, v, y, v.
  [[nodiscard]] std::array<int, 12> takeoff_step_variables(int k) const;
  /// Both ends of flight step `k` and dt^f; the foot is the constant zero at lift-off.
  [[nodiscard]] std::array<int, 17> flight_step_variables(int k) const;
  /// Both ends of landing step `k` and dt^l.
  [[nodiscard]] std::array<int, 13> landing_step_variables(int k) const;

 private:
  static constexpr int kStanceSize = 2 * kStanceDof;
  static constexpr int kFlightSize = 2 * kFlightDof;
  StepCounts steps_;
};

}  // namespace hopscotch::planner
