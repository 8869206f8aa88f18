#include "apps/operator_client.hpp"

#include <algorithm>

#include "apps/stopwatch.hpp"
#include "msgs/event.hpp"

namespace hopscotch::apps {

OperatorClient::OperatorClient(const std::string& url)
    : link_(url, [this] {
        msgs::RunLogHandlers handlers;
        handlers.status = [this](core::Stamp, const msgs::Tagged<msgs::Status>& status) {
          heard_.push_back(status.tag.run_id);
        };
        handlers.ack = [this](core::Stamp, const msgs::Tagged<msgs::Ack>& ack) {
          answers_.push_back(ack);
        };
        return handlers;
      }()) {}

std::vector<std::uint64_t> OperatorClient::running(double patience) {
  constexpr double kCompany_ms = 300.0;  // after the first run is heard, for others to be heard
  heard_.clear();
  std::vector<std::uint64_t> runs;
  const Stopwatch watch;
  double until_ms = 1e3 * patience;
  bool company = false;
  while (watch.milliseconds() < until_ms) {
    constexpr int kStep_ms = 50;
    link_.receive(kStep_ms);
    for (const std::uint64_t run : heard_) {
      if (std::find(runs.begin(), runs.end(), run) == runs.end()) runs.push_back(run);
    }
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
    if (std::find(heard_.begin(), heard_.end(), command.run_id) != heard_.end()) {
      last_sign_ms = watch.milliseconds();
    }
    heard_.clear();
    if (watch.milliseconds() > last_sign_ms + kSilence_ms) break;
  }
  return std::nullopt;
}

}  // namespace hopscotch::apps
