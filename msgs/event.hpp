#pragma once

#include <cstdint>
#include <map>
#include <string_view>

#include "msgs/channels.hpp"
#include "msgs/convert.hpp"

namespace hopscotch::msgs {

/// The channel that a type of value travels on.
constexpr std::string_view channel_of(const core::SensorReadings&) {
  return kSensorsChannel;
}
constexpr std::string_view channel_of(const core::RobotState&) {
  return kStateChannel;
}
constexpr std::string_view channel_of(const core::JointCommand&) {
  return kCommandChannel;
}
constexpr std::string_view channel_of(const core::JumpPlan&) {
  return kPlanChannel;
}
constexpr std::string_view channel_of(const core::OneStepTerrain&) {
  return kTerrainChannel;
}
constexpr std::string_view channel_of(const MapView&) {
  return kMapChannel;
}
constexpr std::string_view channel_of(const core::TargetChoice&) {
  return kTargetChannel;
}
constexpr std::string_view channel_of(const DepthRecord&) {
  return kDepthChannel;
}
constexpr std::string_view channel_of(const AnchorRecord&) {
  return kAnchorChannel;
}
constexpr std::string_view channel_of(const EstimatorPrior&) {
  return kPriorChannel;
}
constexpr std::string_view channel_of(const TargetQuestion&) {
  return kQuestionChannel;
}
constexpr std::string_view channel_of(const TargetCommand&) {
  return kTargetCommandChannel;
}
constexpr std::string_view channel_of(const ModeCommand&) {
  return kModeCommandChannel;
}
constexpr std::string_view channel_of(const Ack&) {
  return kAckChannel;
}
constexpr std::string_view channel_of(const Status&) {
  return kStatusChannel;
}
constexpr std::string_view channel_of(const Truth&) {
  return kTruthChannel;
}
constexpr std::string_view channel_of(const Scene&) {
  return kSceneChannel;
}

/// One message on its way to logs and listeners.
struct Event {
  core::Stamp now;           ///< Moment of writing; the value keeps its own stamp.
  std::string_view channel;  ///< One of `channels.hpp`.
  Bytes bytes;
};

/// Turns the values of one sender into events and numbers them per channel. One thread.
class EventMaker {
 public:
  explicit EventMaker(std::uint64_t run_id) : run_id_(run_id) {}

  template <typename Value>
  [[nodiscard]] Event make(core::Stamp now, const Value& value) {
    const std::string_view channel = channel_of(value);
    return {now, channel, encode(value, {++sequences_[channel], run_id_})};
  }

 private:
  std::uint64_t run_id_;
  std::map<std::string_view, std::uint64_t> sequences_;  // the names are static
};

}  // namespace hopscotch::msgs
