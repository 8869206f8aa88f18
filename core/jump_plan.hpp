#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "core/contact_wrenches.hpp"
#include "core/landing_target.hpp"
#include "core/robot_layout.hpp"
#include "core/robot_state.hpp"

namespace hopscotch::core {

enum class JumpPhase : std::uint8_t { takeoff, flight, landing };

constexpr std::string_view jump_phase_name(JumpPhase phase) {
  switch (phase) {
    case JumpPhase::takeoff: return "takeoff";
    case JumpPhase::flight: return "flight";
    case JumpPhase::landing: return "landing";
  }
  return "takeoff";
}

/// The planned motion at one instant, lifted to 3-D. Point G is the whole-body centre of mass.
/// State quantities hold at `time`; `tau` and `wrenches` are those of the step that starts here
/// (evaluated at its mid-point) and hold until the next knot.
struct JumpKnot {
  double time = kNaN;  ///< Since the start of the plan [s].
  double dt = kNaN;    ///< To the next knot [s]; 0 at the last one.
  JumpPhase phase = JumpPhase::takeoff;
  std::array<bool, kLegs> contact{};
  Eigen::Vector3d p_WB = Eigen::Vector3d::Constant(kNaN);  ///< [m]
  Eigen::Vector3d rpy = Eigen::Vector3d::Constant(kNaN);   ///< Of B in W, R = Rz Ry Rx [rad].
  Eigen::Vector3d v_WB = Eigen::Vector3d::Constant(kNaN);  ///< [m/s]
  Eigen::Vector3d w_WB = Eigen::Vector3d::Constant(kNaN);  ///< In W [rad/s].
  Eigen::Vector3d p_WG = Eigen::Vector3d::Constant(kNaN);  ///< [m]
  Eigen::Vector3d v_WG = Eigen::Vector3d::Constant(kNaN);  ///< [m/s]
  JointVector q = JointVector::Constant(kNaN);             ///< [rad]
  JointVector dq = JointVector::Constant(kNaN);            ///< [rad/s]
  JointVector tau = JointVector::Constant(kNaN);           ///< [N·m]
  ContactWrenches wrenches{};
};

enum class PlanStatus : std::uint8_t { solved, iteration_limit, infeasible, bad_input };

constexpr std::string_view plan_status_name(PlanStatus status) {
  switch (status) {
    case PlanStatus::solved: return "solved";
    case PlanStatus::iteration_limit: return "iteration_limit";
    case PlanStatus::infeasible: return "infeasible";
    case PlanStatus::bad_input: return "bad_input";
  }
  return "bad_input";
}

/// One line of the certificate: how close the plan comes to a physical limit, checked on a 1 ms
/// grid.
struct CertificateEntry {
  std::string_view name;  ///< Static text, e.g. "knee power".
  double margin = kNaN;   ///< Distance to the limit divided by the limit; negative is a breach.
  double time = kNaN;     ///< Where it is smallest [s].
};

struct Certificate {
  static constexpr std::size_t kMaxEntries = 28;
  std::array<CertificateEntry, kMaxEntries> entries{};
  std::size_t count = 0;
  double max_violation = kNaN;        ///< Of the NLP's rows, scaled.
  double dense_max_violation = kNaN;  ///< Of limits and dynamics re-integrated at 1 ms, scaled.

  /// The entry with the smallest margin. @pre count > 0
  [[nodiscard]] const CertificateEntry& binding() const {
    std::size_t best = 0;
    for (std::size_t i = 1; i < count; ++i) {
      if (entries[i].margin < entries[best].margin) best = i;
    }
    return entries[best];
  }
};

/// Largest |value| / limit over the plan.
struct PlanPeaks {
  double torque_ratio = kNaN;
  double speed_ratio = kNaN;
  double power_ratio = kNaN;
  double normal_force = kNaN;  ///< Both feet [N].
};

/// One jump from the standing or landing state that was handed in, to rest at the target.
struct JumpPlan {
  static constexpr std::size_t kMaxKnots = 192;

  std::uint64_t id = 0;
  Stamp stamp;  ///< Of the state it starts from.
  LandingTarget target;
  std::array<JumpKnot, kMaxKnots> knots{};
  std::size_t knot_count = 0;
  double liftoff_time = kNaN;    ///< Since the start of the plan [s].
  double touchdown_time = kNaN;  ///< Since the start of the plan [s].
  double duration = kNaN;        ///< [s]
  PlanStatus status = PlanStatus::bad_input;
  int iterations = 0;
  bool warm = false;
  PlanPeaks peaks;
  Certificate certificate;
};

}  // namespace hopscotch::core
