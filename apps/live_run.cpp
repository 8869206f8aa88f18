#include "apps/live_run.hpp"

#include <chrono>
#include <cstdlib>
#include <utility>

namespace hopscotch::apps {

bool CommandBox::put(const core::OperatorCommand& command) {
  const std::lock_guard lock(mutex_);
  if (waiting_.size() >= kMost) return false;
  waiting_.push_back(command);
  return true;
}

std::vector<core::OperatorCommand> CommandBox::take_all() {
  const std::lock_guard lock(mutex_);
  return std::exchange(waiting_, {});
}

std::string live_url() {
  const char* url = std::getenv("LCM_DEFAULT_URL");
  return url != nullptr && *url != 0 ? url : std::string(msgs::kDefaultUrl);
}

core::OperatorCommand operator_command(const msgs::Tagged<msgs::TargetCommand>& message) {
  return {.run_id = message.tag.run_id,
          .sequence = message.tag.sequence,
          .target = message.value.target,
          .clear_target = !message.value.target.has_value()};
}

core::OperatorCommand operator_command(const msgs::Tagged<msgs::ModeCommand>& message) {
  return {.run_id = message.tag.run_id,
          .sequence = message.tag.sequence,
          .mode = message.value.mode,
          .goal_x = message.value.goal_x,
          .target = {}};
}

msgs::Ack ack_of(core::Stamp now, const core::OperatorAnswer& answer) {
  const bool mode = answer.command.mode != core::ModeRequest::none;
  msgs::Ack ack;
  ack.stamp = now;
  ack.channel = mode ? msgs::kModeCommandChannel : msgs::kTargetCommandChannel;
  ack.command_sequence = answer.command.sequence;
  ack.accepted = answer.accepted();
  ack.refusal = answer.refusal;
  if (ack.accepted) ack.refusal.sentence = answer.remark;
  ack.start_in = answer.start_in;
  return ack;
}

namespace {

msgs::RunLogHandlers into(CommandBox& box) {
  msgs::RunLogHandlers handlers;
  const auto put = [&box](core::Stamp, const auto& message) { box.put(operator_command(message)); };
  handlers.target_command = put;
  handlers.mode_command = put;
  return handlers;
}

constexpr std::size_t kQueueBytes = 8U << 20U;
constexpr std::size_t kQueueItems = 4096;
constexpr auto kSilence = std::chrono::milliseconds(200);

}  // namespace

LiveRun::LiveRun(const std::string& url, CommandBox& box, std::uint64_t run_id)
    : maker_(run_id),
      commands_(url, into(box)),
      events_(url),
      outbox_([this](const Told& told) { return deliver(told); },
              {.bytes = kQueueBytes, .items = kQueueItems},
              {.after = kSilence, .act = [this] {
                 if (last_status_) events_.publish(last_status_->channel, last_status_->bytes);
               }}) {
  receiver_ = std::thread([this] {
    constexpr int kPatience = 100;  // [ms], then look whether the run is over
    while (!closing_) commands_.receive(kPatience);
  });
}

LiveRun::~LiveRun() {
  closing_ = true;
  receiver_.join();
}

void LiveRun::publish(const msgs::Event& event) {
  outbox_.put({event.now, event}, event.bytes.size());
}

void LiveRun::tell(core::Stamp now, const msgs::Status& status) {
  outbox_.put({now, status}, sizeof status);
}

void LiveRun::tell(core::Stamp now, msgs::Ack answer) {
  outbox_.put({now, std::move(answer)}, sizeof answer);
}

bool LiveRun::deliver(const Told& told) {
  if (const auto* const event = std::get_if<msgs::Event>(&told.what)) {
    return events_.publish(event->channel, event->bytes);
  }
  if (const auto* const status = std::get_if<msgs::Status>(&told.what)) {
    last_status_ = maker_.make(told.now, *status);
    return events_.publish(last_status_->channel, last_status_->bytes);
  }
  const msgs::Event answer = maker_.make(told.now, std::get<msgs::Ack>(told.what));
  return events_.publish(answer.channel, answer.bytes);
}

}  // namespace hopscotch::apps
