#include "hopscotch_msgs/prior.hpp"
#include "hopscotch_msgs/question.hpp"
#include "msgs/convert.hpp"
#include "msgs/wire.hpp"
#include "msgs/wire_state.hpp"

/// What a replay needs besides what the stages exchange.
namespace hopscotch::msgs {

Bytes encode(const AnchorRecord& value, const Tag& tag) {
  return wire::encode_state<hopscotch_msgs::exact_state>(value.state, tag);
}

template <>
std::optional<Tagged<AnchorRecord>> decode(std::span<const std::uint8_t> bytes) {
  const auto state = wire::decode_state<hopscotch_msgs::exact_state>(bytes);
  if (!state) return std::nullopt;
  return Tagged<AnchorRecord>{state->tag, {state->value}};
}

Bytes encode(const TargetQuestion& value, const Tag& tag) {
  hopscotch_msgs::question message{};
  wire::set_header(value.stamp, tag, message);
  wire::set_header(value.rest.stamp, tag, message.rest);
  wire::put_state(value.rest, message.rest);
  message.map_stamp_ns = value.map_stamp.nanoseconds;
  message.for_operator = static_cast<std::int8_t>(value.for_operator);
  message.goal_x = value.goal_x;
  message.goal_heading_rad = value.goal_heading;
  message.source = wire::number_of(value.source);
  message.has_override = value.target.has_value();
  const core::TargetOverride wanted = value.target.value_or(core::TargetOverride{});
  message.distance = wanted.distance;
  message.height = wanted.height;
  message.lateral = wanted.lateral;
  message.yaw_rad = wanted.yaw;
  message.height_doubt = value.height_doubt;
  return wire::to_bytes(message);
}

template <>
std::optional<Tagged<TargetQuestion>> decode(std::span<const std::uint8_t> bytes) {
  const auto message = wire::from_bytes<hopscotch_msgs::question>(bytes);
  if (!message) return std::nullopt;
  TargetQuestion value;
  value.stamp = wire::stamp_of(*message);
  wire::get_state(message->rest, value.rest);
  value.map_stamp = core::Stamp{message->map_stamp_ns};
  value.for_operator = message->for_operator != 0;
  value.goal_x = message->goal_x;
  value.goal_heading = message->goal_heading_rad;
  value.height_doubt = message->height_doubt;
  if (!wire::get_enum(message->source, core::TargetSource::operator_override, value.source)) {
    return std::nullopt;
  }
  if (message->has_override != 0) {
    value.target = core::TargetOverride{.distance = message->distance,
                                        .height = message->height,
                                        .lateral = message->lateral,
                                        .yaw = message->yaw_rad};
  }
  return Tagged<TargetQuestion>{wire::tag_of(*message), value};
}

Bytes encode(const EstimatorPrior& value, const Tag& tag) {
  hopscotch_msgs::prior message{};
  wire::set_header(value.stamp, tag, message);
  message.starts = value.start.has_value();
  const EstimatorPrior::Start start = value.start.value_or(EstimatorPrior::Start{});
  wire::put(start.p_WS, message.p_WS);
  message.yaw = start.yaw;
  message.expected = value.expected;
  message.height = value.height;
  return wire::to_bytes(message);
}

template <>
std::optional<Tagged<EstimatorPrior>> decode(std::span<const std::uint8_t> bytes) {
  const auto message = wire::from_bytes<hopscotch_msgs::prior>(bytes);
  if (!message) return std::nullopt;
  EstimatorPrior value;
  value.stamp = wire::stamp_of(*message);
  if (message->starts != 0) {
    value.start = EstimatorPrior::Start{};
    wire::get(message->p_WS, value.start->p_WS);
    value.start->yaw = message->yaw;
  }
  value.expected = message->expected;
  value.height = message->height;
  return Tagged<EstimatorPrior>{wire::tag_of(*message), value};
}

}  // namespace hopscotch::msgs
