#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "apps/explain.hpp"
#include "apps/run_folder.hpp"
#include "core/control_status.hpp"
#include "core/jump_plan.hpp"
#include "core/landing_target.hpp"
#include "model/robot_parameters.hpp"
#include "msgs/messages.hpp"

namespace hopscotch::apps {

/// One moment of a log, as the detectors look at it.
struct Sample {
  double time = core::kNaN;   ///< Since the start of the run [s].
  core::RobotState truth;     ///< Of the plant; the controller's own state where there is no plant.
  core::RobotState believed;  ///< By the controller.
  core::ContactWrenches ground{};                                   ///< NaN without a plant.
  core::JointVector tau = core::JointVector::Constant(core::kNaN);  ///< Applied [N·m].
  core::ControlStatus status;
  int jump = 0;
  int deadline_misses = 0;
  Eigen::Vector3d v_WG = Eigen::Vector3d::Constant(core::kNaN);  ///< Whole-body CoM [m/s].
  std::array<Eigen::Vector3d, core::kLegs> toe{};                ///< Tips in W [m].
  std::array<Eigen::Vector3d, core::kLegs> heel{};
  std::array<double, core::kLegs> load{};  ///< Upward force on each foot [N].
};

/// The last jump of a run, or its last seconds when it was not jumping. What the controller
/// believed and planned stands in the plant's world, as if it had known its place when these
/// seconds began.
struct Evidence {
  RunResult result;
  model::RobotParameters robot;
  double mass = core::kNaN;  ///< Of the plant, which may be scaled [kg].
  bool has_truth = false;
  std::vector<Sample> samples;               ///< In order of time; of the last attempt only.
  std::optional<core::JumpPlan> plan;        ///< Of that jump.
  std::optional<core::TargetChoice> choice;  ///< The last decision of the run.
};

/// @throws std::runtime_error, core::ConfigError naming the file that is missing or broken.
[[nodiscard]] Evidence collect_evidence(const RunFolder& folder);

/// Each looks for one kind of cause; nothing found is the usual answer.
using Detector = std::optional<Clue> (*)(const Evidence&);
[[nodiscard]] const std::vector<Detector>& detectors();

}  // namespace hopscotch::apps
