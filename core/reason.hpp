#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>

namespace hopscotch::core {

/// Why something was refused, failed or ended. The one list that results, failures, refusals and
/// `explain` share; the spelling of `reason_code` is part of the file formats.
enum class Reason : std::uint8_t {
  none,
  // refusals: the robot stands
  no_safe_target,
  gap_too_wide,
  step_too_high,
  step_too_low,
  terrain_unseen,
  tread_too_short,
  out_of_reach,
  target_malformed,
  plan_infeasible,
  plan_late,
  certificate_refused,
  // outcomes of a jump
  fell_in_takeoff,
  fell_in_flight,
  fell_in_landing,
  fell_standing,
  over_edge,
  no_touchdown,
  slipped,
  // faults
  stale_sensors,
  bad_sensor_value,
  joint_limit,
  tilt_limit,
  deadline,
  mpc_failed,
  drive_silent,
  drive_fault,
  drive_mismatch,
  encoder_stuck,
  bus_fault,
  imu_lost,
  not_homed,
  // answers to an operator's command
  wrong_run,
  stale_command,
  repeated_command,
  not_now,
  withdrawn,
  // ends by choice
  stopped_by_user,
  jump_count_reached,
  time_limit,
  internal_error,
};

/// Stable identifier used in JSON, logs and messages.
constexpr std::string_view reason_code(Reason reason) {
  switch (reason) {
    case Reason::none: return "";
    case Reason::no_safe_target: return "no_safe_target";
    case Reason::gap_too_wide: return "gap_too_wide";
    case Reason::step_too_high: return "step_too_high";
    case Reason::step_too_low: return "step_too_low";
    case Reason::terrain_unseen: return "terrain_unseen";
    case Reason::tread_too_short: return "tread_too_short";
    case Reason::out_of_reach: return "out_of_reach";
    case Reason::target_malformed: return "target_malformed";
    case Reason::plan_infeasible: return "plan_infeasible";
    case Reason::plan_late: return "plan_late";
    case Reason::certificate_refused: return "certificate_refused";
    case Reason::fell_in_takeoff: return "fell_in_takeoff";
    case Reason::fell_in_flight: return "fell_in_flight";
    case Reason::fell_in_landing: return "fell_in_landing";
    case Reason::fell_standing: return "fell_standing";
    case Reason::over_edge: return "over_edge";
    case Reason::no_touchdown: return "no_touchdown";
    case Reason::slipped: return "slipped";
    case Reason::stale_sensors: return "stale_sensors";
    case Reason::bad_sensor_value: return "bad_sensor_value";
    case Reason::joint_limit: return "joint_limit";
    case Reason::tilt_limit: return "tilt_limit";
    case Reason::deadline: return "deadline";
    case Reason::mpc_failed: return "mpc_failed";
    case Reason::drive_silent: return "drive_silent";
    case Reason::drive_fault: return "drive_fault";
    case Reason::drive_mismatch: return "drive_mismatch";
    case Reason::encoder_stuck: return "encoder_stuck";
    case Reason::bus_fault: return "bus_fault";
    case Reason::imu_lost: return "imu_lost";
    case Reason::not_homed: return "not_homed";
    case Reason::wrong_run: return "wrong_run";
    case Reason::stale_command: return "stale_command";
    case Reason::repeated_command: return "repeated_command";
    case Reason::not_now: return "not_now";
    case Reason::withdrawn: return "withdrawn";
    case Reason::stopped_by_user: return "stopped_by_user";
    case Reason::jump_count_reached: return "jump_count_reached";
    case Reason::time_limit: return "time_limit";
    case Reason::internal_error: return "internal_error";
  }
  return "internal_error";
}

/// The answer "no": a code for machines and a sentence with the numbers for people.
struct Refusal {
  Reason reason = Reason::none;
  std::string sentence;

  /// "code: sentence", as it stands in results.
  [[nodiscard]] std::string text() const {
    return std::string(reason_code(reason)) + (sentence.empty() ? "" : ": " + sentence);
  }
};

}  // namespace hopscotch::core
