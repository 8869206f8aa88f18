#include "msgs/dispatcher.hpp"

#include <utility>

#include "msgs/channels.hpp"

namespace hopscotch::msgs {

Dispatcher::Dispatcher(RunLogHandlers handlers) : handlers_(std::move(handlers)) {
  on(kSensorsChannel, handlers_.sensors);
  on(kStateChannel, handlers_.state);
  on(kCommandChannel, handlers_.command);
  on(kPlanChannel, handlers_.plan);
  on(kTerrainChannel, handlers_.terrain);
  on(kMapChannel, handlers_.map);
  on(kTargetChannel, handlers_.target);
  on(kDepthChannel, handlers_.depth);
  on(kAnchorChannel, handlers_.anchor);
  on(kPriorChannel, handlers_.prior);
  on(kQuestionChannel, handlers_.question);
  on(kTargetCommandChannel, handlers_.target_command);
  on(kModeCommandChannel, handlers_.mode_command);
  on(kAckChannel, handlers_.ack);
  on(kStatusChannel, handlers_.status);
  on(kTruthChannel, handlers_.truth);
  on(kSceneChannel, handlers_.scene);
}

template <typename Value>
void Dispatcher::on(std::string_view channel, const RunLogHandlers::Handler<Value>& handler) {
  Entry& entry = entries_[channel];
  if (!handler) return;
  entry = [this, &handler](core::Stamp written, std::span<const std::uint8_t> bytes) {
    if (const auto message = decode<Value>(bytes)) {
      handler(written, *message);
    } else {
      ++summary_.malformed;
    }
  };
}

void Dispatcher::take(core::Stamp written, std::string_view channel,
                      std::span<const std::uint8_t> bytes) {
  ++summary_.events;
  const auto entry = entries_.find(channel);
  if (entry == entries_.end()) {
    ++summary_.unknown;
  } else if (entry->second) {
    entry->second(written, bytes);
  }
}

std::vector<std::string_view> Dispatcher::channels() const {
  std::vector<std::string_view> result;
  for (const auto& [channel, entry] : entries_) {
    if (entry) result.push_back(channel);
  }
  return result;
}

}  // namespace hopscotch::msgs
