#include "hopscotch_msgs/command.hpp"
#include "hopscotch_msgs/plan.hpp"
#include "hopscotch_msgs/sensors.hpp"
#include "msgs/convert.hpp"
#include "msgs/wire.hpp"
#include "msgs/wire_state.hpp"
#include "msgs/wire_target.hpp"

namespace hopscotch::msgs {

namespace {

void put_knot(const core::JumpKnot& from, hopscotch_msgs::knot& to) {
  to.time = from.time;
  to.dt = from.dt;
  to.phase = wire::number_of(from.phase);
  for (std::size_t leg = 0; leg < from.contact.size(); ++leg) to.contact[leg] = from.contact[leg];
  wire::put(from.p_WB, to.p_WB);
  wire::put(from.rpy, to.rpy);
  wire::put(from.v_WB, to.v_WB);
  wire::put(from.w_WB, to.w_WB);
  wire::put(from.p_WG, to.p_WG);
  wire::put(from.v_WG, to.v_WG);
  wire::put(from.q, to.q);
  wire::put(from.dq, to.dq);
  wire::put(from.tau, to.tau);
  wire::put_wrenches(from.wrenches, to);
}

bool get_knot(const hopscotch_msgs::knot& from, core::JumpKnot& to) {
  to.time = from.time;
  to.dt = from.dt;
  for (std::size_t leg = 0; leg < to.contact.size(); ++leg)
    to.contact[leg] = from.contact[leg] != 0;
  wire::get(from.p_WB, to.p_WB);
  wire::get(from.rpy, to.rpy);
  wire::get(from.v_WB, to.v_WB);
  wire::get(from.w_WB, to.w_WB);
  wire::get(from.p_WG, to.p_WG);
  wire::get(from.v_WG, to.v_WG);
  wire::get(from.q, to.q);
  wire::get(from.dq, to.dq);
  wire::get(from.tau, to.tau);
  wire::get_wrenches(from, to.wrenches);
  return wire::get_enum(from.phase, core::JumpPhase::landing, to.phase);
}

void put_summary(const core::JumpPlan& from, hopscotch_msgs::plan& to) {
  to.plan_id = static_cast<std::int64_t>(from.id);
  to.liftoff_time = from.liftoff_time;
  to.touchdown_time = from.touchdown_time;
  to.duration = from.duration;
  to.status = wire::number_of(from.status);
  to.iterations = from.iterations;
  to.warm = from.warm;
  to.peak_torque_ratio = from.peaks.torque_ratio;
  to.peak_speed_ratio = from.peaks.speed_ratio;
  to.peak_power_ratio = from.peaks.power_ratio;
  to.peak_normal_force = from.peaks.normal_force;
  to.max_violation = from.certificate.max_violation;
  to.dense_max_violation = from.certificate.dense_max_violation;
}

bool get_summary(const hopscotch_msgs::plan& from, core::JumpPlan& to) {
  to.id = static_cast<std::uint64_t>(from.plan_id);
  to.liftoff_time = from.liftoff_time;
  to.touchdown_time = from.touchdown_time;
  to.duration = from.duration;
  to.iterations = from.iterations;
  to.warm = from.warm != 0;
  to.peaks = {from.peak_torque_ratio, from.peak_speed_ratio, from.peak_power_ratio,
              from.peak_normal_force};
  to.certificate.max_violation = from.max_violation;
  to.certificate.dense_max_violation = from.dense_max_violation;
  return wire::get_enum(from.status, core::PlanStatus::bad_input, to.status);
}

}  // namespace

Bytes encode(const core::SensorReadings& value, const Tag& tag) {
  hopscotch_msgs::sensors message{};
  wire::set_header(value.stamp, tag, message);
  wire::put(value.q, message.q);
  wire::put(value.dq, message.dq);
  wire::put(value.tau, message.tau);
  wire::put(value.w_WB_B, message.w_WB_B);
  wire::put(value.f_B, message.f_B);
  return wire::to_bytes(message);
}

template <>
std::optional<Tagged<core::SensorReadings>> decode(std::span<const std::uint8_t> bytes) {
  const auto message = wire::from_bytes<hopscotch_msgs::sensors>(bytes);
  if (!message) return std::nullopt;
  core::SensorReadings value;
  value.stamp = wire::stamp_of(*message);
  wire::get(message->q, value.q);
  wire::get(message->dq, value.dq);
  wire::get(message->tau, value.tau);
  wire::get(message->w_WB_B, value.w_WB_B);
  wire::get(message->f_B, value.f_B);
  return Tagged<core::SensorReadings>{wire::tag_of(*message), value};
}

Bytes encode(const core::RobotState& value, const Tag& tag) {
  return wire::encode_state<hopscotch_msgs::robot_state>(value, tag);
}

template <>
std::optional<Tagged<core::RobotState>> decode(std::span<const std::uint8_t> bytes) {
  return wire::decode_state<hopscotch_msgs::robot_state>(bytes);
}

Bytes encode(const core::JointCommand& value, const Tag& tag) {
  hopscotch_msgs::command message{};
  wire::set_header(value.stamp, tag, message);
  message.mode = wire::number_of(value.mode);
  wire::put(value.q, message.q);
  wire::put(value.dq, message.dq);
  wire::put(value.kp, message.kp);
  wire::put(value.kd, message.kd);
  wire::put(value.tau, message.tau);
  return wire::to_bytes(message);
}

template <>
std::optional<Tagged<core::JointCommand>> decode(std::span<const std::uint8_t> bytes) {
  const auto message = wire::from_bytes<hopscotch_msgs::command>(bytes);
  if (!message) return std::nullopt;
  core::JointCommand value;
  value.stamp = wire::stamp_of(*message);
  if (!wire::get_enum(message->mode, core::DriveMode::active, value.mode)) return std::nullopt;
  wire::get(message->q, value.q);
  wire::get(message->dq, value.dq);
  wire::get(message->kp, value.kp);
  wire::get(message->kd, value.kd);
  wire::get(message->tau, value.tau);
  return Tagged<core::JointCommand>{wire::tag_of(*message), value};
}

Bytes encode(const core::JumpPlan& value, const Tag& tag) {
  hopscotch_msgs::plan message{};
  wire::set_header(value.stamp, tag, message);
  wire::put(value.target, message.target);
  put_summary(value, message);
  message.knot_count = static_cast<std::int32_t>(value.knot_count);
  message.knots.resize(value.knot_count);
  for (std::size_t i = 0; i < value.knot_count; ++i) put_knot(value.knots[i], message.knots[i]);
  return wire::to_bytes(message);
}

template <>
std::optional<Tagged<core::JumpPlan>> decode(std::span<const std::uint8_t> bytes) {
  const auto message = wire::from_bytes_with_list<hopscotch_msgs::plan>(bytes);
  if (!message) return std::nullopt;
  Tagged<core::JumpPlan> result{wire::tag_of(*message), {}};
  core::JumpPlan& value = result.value;
  value.stamp = wire::stamp_of(*message);
  if (!wire::get(message->target, value.target) || !get_summary(*message, value) ||
      !wire::get_count(message->knot_count, value.knots.size(), value.knot_count)) {
    return std::nullopt;
  }
  for (std::size_t i = 0; i < value.knot_count; ++i) {
    if (!get_knot(message->knots[i], value.knots[i])) return std::nullopt;
  }
  return result;
}

}  // namespace hopscotch::msgs
