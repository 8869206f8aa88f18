#include "apps/operator_client.hpp"

#include <algorithm>

#include "apps/stopwatch.hpp"
#include "msgs/event.hpp"

namespace hopscotch::apps {

void note_status(const msgs::Tag& tag, std::vector<RunOnAir>& runs) {
  const auto known =
      std::find_if(runs.begin(), runs.end(), [&](const RunOnAir& r) { return r.id == tag.run_id; });
  if (known == runs.end()) {
    runs.push_back({.id = tag.run_id, .sequence = tag.sequence});
    return;
  }
  if (tag.sequence <= known->sequence) known->is_alone = false;
  known->sequence = tag.sequence;
}

OperatorClient::OperatorClient(const std::string& url)
    : link_(url, [this] {
        msgs::RunLogHandlers handlers;
        handlers.status = [this](core::Stamp, const msgs::Tagged<msgs::Status>& status) {
          heard_.push_back(status.tag);
        };
        handlers.ack = [this](core::Stamp, const msgs::Tagged<msgs::Ack>& ack) {
          answers_.push_back(ack);
        };
        return handlers;
      }()) {}

std::vector<RunOnAir> OperatorClient::running(double patience) {
  constexpr double kCompany_ms = 300.0;  // after the first run is heard, for others to be heard
  heard_.clear();
  std::vector<RunOnAir> runs;
  const Stopwatch watch;
  double until_ms = 1e3 * patience;
  bool company = false;
  while (watch.milliseconds() < until_ms) {
    constexpr int kStep_ms = 50;
    link_.receive(kStep_ms);
    for (const msgs::Tag& tag : heard_) note_status(tag, runs);
    if (!runs.empty() && !company) {
      company = true;
      until_ms = std::min(until_ms, watch.milliseconds() + kCompany_ms);
    }
    heard_.clear();
  }
  return runs;
}

std::optional<msgs::Ack> OperatorClient::ask(const core::OperatorCommand& command,
                                             double patience) {
  const msgs::Tag tag{command.sequence, command.run_id};
  const core::Stamp made{static_cast<std::int64_t>(command.sequence) * 1000};
  if (command.mode == core::ModeRequest::none) {
    const msgs::TargetCommand message{made, command.target};
    link_.publish(msgs::channel_of(message), msgs::encode(message, tag));
  } else {
    const msgs::ModeCommand message{made, command.mode, command.goal_x};
    link_.publish(msgs::channel_of(message), msgs::encode(message, tag));
  }
  answers_.clear();
  heard_.clear();
  constexpr double kSilence_ms = 2000.0;  // a run that is on tells its status far more often
  const Stopwatch watch;
  double last_sign_ms = 0.0;
  while (watch.milliseconds() < 1e3 * patience) {
    constexpr int kStep_ms = 50;
    link_.receive(kStep_ms);
    for (const msgs::Tagged<msgs::Ack>& ack : answers_) {
      if (ack.tag.run_id == command.run_id && ack.value.command_sequence == command.sequence) {
        return ack.value;
      }
    }
    answers_.clear();
    const bool is_on = std::any_of(heard_.begin(), heard_.end(), [&](const msgs::Tag& tag) {
      return tag.run_id == command.run_id;
    });
    if (is_on) last_sign_ms = watch.milliseconds();
    heard_.clear();
    if (watch.milliseconds() > last_sign_ms + kSilence_ms) break;
  }
  return std::nullopt;
}

}  // namespace hopscotch::apps
