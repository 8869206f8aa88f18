#include "apps/black_box.hpp"

#include "msgs/run_log.hpp"

namespace hopscotch::apps {

void BlackBox::remember(const msgs::Event& event) {
  events_.push_back(event);
  bytes_ += event.bytes.size();
  while (event.now.since(events_.front().now) > kSeconds || bytes_ > kMostBytes) {
    bytes_ -= events_.front().bytes.size();
    events_.pop_front();
    if (events_.empty()) return;
  }
}

void BlackBox::write(const std::filesystem::path& file, const msgs::Event& scene) const {
  constexpr std::uint64_t kNobody = 0;  // the events carry their own sender
  msgs::RunLogWriter log(file, kNobody);
  // A player waits from one moment to the next.
  const core::Stamp begin = events_.empty() ? scene.now : events_.front().now;
  log.write({begin, scene.channel, scene.bytes});
  for (const msgs::Event& event : events_) log.write(event);
  log.close();
}

}  // namespace hopscotch::apps
