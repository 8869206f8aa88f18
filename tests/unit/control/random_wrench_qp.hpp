#pragma once

#include <random>

#include "control/wrench_qp.hpp"

namespace hopscotch::control::testing {

/// Which feet stand in which step.
enum class ContactPattern { both, left_only, alternating, through_flight };

/// What a random problem may look like.
struct QpFamily {
  ContactPattern contact = ContactPattern::both;
  int horizon = 10;
  double spread = 0.1;        ///< Of states, attitudes and references.
  double friction = 0.5;      ///< [-]
  double top = 400.0;         ///< [N]
  double dt = 0.03;           ///< Mean step; steps vary by half of it [s].
  double weight_scale = 1.0;  ///< Of the input weights.
  bool yaw_moment_free = false;
  bool with_reference = false;  ///< Wrench cost about a wrench instead of zero.
  StepRule rule = StepRule::zero_order_hold;
};

/// A problem of HECTOR's size about a stand: mass 14 kg, CoM 0.4 m above the soles.
[[nodiscard]] WrenchQp random_wrench_qp(const QpFamily& family, std::mt19937& rng);

}  // namespace hopscotch::control::testing
