#include "hopscotch_msgs/ack.hpp"
#include "hopscotch_msgs/command_cmd.hpp"
#include "hopscotch_msgs/target_cmd.hpp"
#include "msgs/convert.hpp"
#include "msgs/wire.hpp"

namespace hopscotch::msgs {

Bytes encode(const TargetCommand& value, const Tag& tag) {
  hopscotch_msgs::target_cmd message{};
  wire::set_header(value.stamp, tag, message);
  message.clear = !value.target.has_value();
  const core::TargetOverride target = value.target.value_or(core::TargetOverride{});
  message.distance = target.distance;
  message.height = target.height;
  message.lateral = target.lateral;
  message.yaw_rad = target.yaw;
  return wire::to_bytes(message);
}

template <>
std::optional<Tagged<TargetCommand>> decode(std::span<const std::uint8_t> bytes) {
  const auto message = wire::from_bytes<hopscotch_msgs::target_cmd>(bytes);
  if (!message) return std::nullopt;
  TargetCommand value;
  value.stamp = wire::stamp_of(*message);
  if (message->clear == 0) {
    value.target = core::TargetOverride{message->distance, message->height, message->lateral,
                                        message->yaw_rad};
  }
  return Tagged<TargetCommand>{wire::tag_of(*message), value};
}

Bytes encode(const ModeCommand& value, const Tag& tag) {
  hopscotch_msgs::command_cmd message{};
  wire::set_header(value.stamp, tag, message);
  message.mode = wire::number_of(value.mode);
  message.goal_x = value.goal_x;
  return wire::to_bytes(message);
}

template <>
std::optional<Tagged<ModeCommand>> decode(std::span<const std::uint8_t> bytes) {
  const auto message = wire::from_bytes<hopscotch_msgs::command_cmd>(bytes);
  if (!message) return std::nullopt;
  ModeCommand value;
  value.stamp = wire::stamp_of(*message);
  value.goal_x = message->goal_x;
  if (!wire::get_enum(message->mode, core::ModeRequest::clear_fault, value.mode)) {
    return std::nullopt;
  }
  return Tagged<ModeCommand>{wire::tag_of(*message), value};
}

Bytes encode(const Ack& value, const Tag& tag) {
  hopscotch_msgs::ack message{};
  wire::set_header(value.stamp, tag, message);
  message.channel = value.channel;
  message.command_sequence = static_cast<std::int64_t>(value.command_sequence);
  message.accepted = value.accepted;
  message.reason = wire::number_of(value.refusal.reason);
  message.sentence = value.refusal.sentence;
  message.start_in = value.start_in;
  return wire::to_bytes(message);
}

template <>
std::optional<Tagged<Ack>> decode(std::span<const std::uint8_t> bytes) {
  const auto message = wire::from_bytes<hopscotch_msgs::ack>(bytes);
  if (!message) return std::nullopt;
  Ack value;
  value.stamp = wire::stamp_of(*message);
  value.channel = wire::text_of(message->channel);
  value.command_sequence = static_cast<std::uint64_t>(message->command_sequence);
  value.accepted = message->accepted != 0;
  value.refusal.sentence = wire::text_of(message->sentence);
  value.start_in = message->start_in;
  if (!wire::get_enum(message->reason, core::Reason::internal_error, value.refusal.reason)) {
    return std::nullopt;
  }
  return Tagged<Ack>{wire::tag_of(*message), value};
}

}  // namespace hopscotch::msgs
