#include "hopscotch_msgs/scene.hpp"
#include "hopscotch_msgs/status.hpp"
#include "hopscotch_msgs/truth.hpp"
#include "msgs/convert.hpp"
#include "msgs/wire.hpp"
#include "msgs/wire_state.hpp"

namespace hopscotch::msgs {

static_assert(hopscotch_msgs::scene::MAX_SLABS == Scene::kMaxSlabs);

Bytes encode(const Status& value, const Tag& tag) {
  hopscotch_msgs::status message{};
  wire::set_header(value.control.stamp, tag, message);
  message.phase = wire::number_of(value.control.phase);
  message.fault = wire::number_of(value.control.fault);
  message.jump = value.jump;
  message.plan_id = static_cast<std::int64_t>(value.control.plan_id);
  message.plan_time = value.control.plan_time;
  wire::put_wrenches(value.control.wrenches, message);
  message.deadline_misses = value.deadline_misses;
  message.held = value.held;
  message.tick_ms = static_cast<float>(value.times.tick_ms);
  message.mpc_ms = static_cast<float>(value.times.mpc_ms);
  message.plan_ms = static_cast<float>(value.times.plan_ms);
  message.perception_ms = static_cast<float>(value.times.perception_ms);
  message.estimator_ms = static_cast<float>(value.times.estimator_ms);
  return wire::to_bytes(message);
}

template <>
std::optional<Tagged<Status>> decode(std::span<const std::uint8_t> bytes) {
  const auto message = wire::from_bytes<hopscotch_msgs::status>(bytes);
  if (!message) return std::nullopt;
  Status value;
  core::ControlStatus& control = value.control;
  control.stamp = wire::stamp_of(*message);
  control.plan_id = static_cast<std::uint64_t>(message->plan_id);
  control.plan_time = message->plan_time;
  wire::get_wrenches(*message, control.wrenches);
  value.jump = message->jump;
  value.deadline_misses = message->deadline_misses;
  value.held = message->held != 0;
  value.times = {message->tick_ms, message->mpc_ms, message->plan_ms, message->perception_ms,
                 message->estimator_ms};
  if (!wire::get_enum(message->phase, core::RobotPhase::fault, control.phase) ||
      !wire::get_enum(message->fault, core::Reason::internal_error, control.fault)) {
    return std::nullopt;
  }
  return Tagged<Status>{wire::tag_of(*message), value};
}

Bytes encode(const Truth& value, const Tag& tag) {
  hopscotch_msgs::truth message{};
  wire::set_header(value.stamp, tag, message);
  wire::set_header(value.state.stamp, tag, message.state);
  wire::put_state(value.state, message.state);
  wire::put_wrenches(value.ground, message);
  wire::put(value.tau, message.tau);
  return wire::to_bytes(message);
}

template <>
std::optional<Tagged<Truth>> decode(std::span<const std::uint8_t> bytes) {
  const auto message = wire::from_bytes<hopscotch_msgs::truth>(bytes);
  if (!message) return std::nullopt;
  Truth value;
  value.stamp = wire::stamp_of(*message);
  wire::get_state(message->state, value.state);
  wire::get_wrenches(*message, value.ground);
  wire::get(message->tau, value.tau);
  return Tagged<Truth>{wire::tag_of(*message), value};
}

Bytes encode(const Scene& value, const Tag& tag) {
  hopscotch_msgs::scene message{};
  wire::set_header(value.stamp, tag, message);
  message.robot = value.robot;
  message.goal_x = value.goal_x;
  message.pit_z = value.pit_z;
  message.slab_count = static_cast<std::int32_t>(value.slab_count);
  for (std::size_t i = 0; i < value.slab_count; ++i) {
    for (std::size_t k = 0; k < 4; ++k) wire::put(value.slabs[i].top[k], message.top[i][k]);
    message.seen_rise[i] = value.slabs[i].seen_rise;
  }
  return wire::to_bytes(message);
}

template <>
std::optional<Tagged<Scene>> decode(std::span<const std::uint8_t> bytes) {
  const auto message = wire::from_bytes<hopscotch_msgs::scene>(bytes);
  if (!message) return std::nullopt;
  Scene value;
  value.stamp = wire::stamp_of(*message);
  value.robot = wire::text_of(message->robot);
  value.goal_x = message->goal_x;
  value.pit_z = message->pit_z;
  if (!wire::get_count(message->slab_count, value.slabs.size(), value.slab_count)) {
    return std::nullopt;
  }
  for (std::size_t i = 0; i < value.slab_count; ++i) {
    for (std::size_t k = 0; k < 4; ++k) wire::get(message->top[i][k], value.slabs[i].top[k]);
    value.slabs[i].seen_rise = message->seen_rise[i];
  }
  return Tagged<Scene>{wire::tag_of(*message), value};
}

}  // namespace hopscotch::msgs
