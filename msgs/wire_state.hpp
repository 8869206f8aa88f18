#pragma once

#include "core/robot_state.hpp"
#include "hopscotch_msgs/exact_state.hpp"
#include "hopscotch_msgs/robot_state.hpp"
#include "msgs/wire.hpp"

/// What HOP_STATE, HOP_TRUTH and the records for a replay share. Private to this folder.
namespace hopscotch::msgs::wire {

/// All but the header.
template <typename Message>
void put_state(const core::RobotState& from, Message& to) {
  put(from.p_WB, to.p_WB);
  put(from.R_WB, to.R_WB);
  put(from.v_WB, to.v_WB);
  put(from.w_WB, to.w_WB);
  put(from.q, to.q);
  put(from.dq, to.dq);
  for (std::size_t leg = 0; leg < from.contact.size(); ++leg) to.contact[leg] = from.contact[leg];
}

template <typename Message>
void get_state(const Message& from, core::RobotState& to) {
  to.stamp = stamp_of(from);
  get(from.p_WB, to.p_WB);
  get(from.R_WB, to.R_WB);
  get(from.v_WB, to.v_WB);
  get(from.w_WB, to.w_WB);
  get(from.q, to.q);
  get(from.dq, to.dq);
  for (std::size_t leg = 0; leg < to.contact.size(); ++leg)
    to.contact[leg] = from.contact[leg] != 0;
}

/// A message that is a state and nothing else.
template <typename Message>
Bytes encode_state(const core::RobotState& value, const Tag& tag) {
  Message message{};
  set_header(value.stamp, tag, message);
  put_state(value, message);
  return to_bytes(message);
}

template <typename Message>
std::optional<Tagged<core::RobotState>> decode_state(std::span<const std::uint8_t> bytes) {
  const auto message = from_bytes<Message>(bytes);
  if (!message) return std::nullopt;
  core::RobotState value;
  get_state(*message, value);
  return Tagged<core::RobotState>{tag_of(*message), value};
}

}  // namespace hopscotch::msgs::wire
