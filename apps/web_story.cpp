#include "apps/web_story.hpp"

#include <algorithm>
#include <limits>
#include <mutex>
#include <utility>
#include <vector>

#include "apps/web_json.hpp"

namespace hopscotch::apps {

struct WebStory::Pages {
  /// Pictures per simulated second: the page interpolates between them.
  static constexpr double kFramePeriod = 1.0 / 60.0;

  model::RobotParameters robot;
  Header header;

  mutable std::mutex mutex;
  std::string scene = "null";
  std::vector<std::string> frames;
  std::vector<std::string> happenings;

  // The writer's own, until they are a frame.
  WebMoment moment;
  bool simulated = false;
  double next_frame = -std::numeric_limits<double>::infinity();  // [s]

  void add_frame() {
    const double time = moment.status.control.stamp.seconds();
    moment.work.include(moment.status.times);
    if (time < next_frame) return;
    next_frame = time + kFramePeriod - 1e-6;
    std::string frame = frame_json(moment, robot);
    moment.work = {};
    const std::lock_guard lock(mutex);
    frames.push_back(std::move(frame));
  }
  void add_happening(std::string json) {
    const std::lock_guard lock(mutex);
    happenings.push_back(std::move(json));
  }
};

WebStory::WebStory(const model::RobotParameters& robot, const Header& header)
    : pages_(std::make_unique<Pages>()) {
  pages_->robot = robot;
  pages_->header = header;
}
WebStory::~WebStory() = default;

msgs::RunLogHandlers WebStory::handlers() {
  Pages& pages = *pages_;
  msgs::RunLogHandlers handlers;
  handlers.scene = [&pages](core::Stamp, const auto& message) {
    pages.simulated = true;
    const std::lock_guard lock(pages.mutex);
    pages.scene = scene_json(message.value);
  };
  handlers.state = [&pages](core::Stamp, const auto& message) {
    pages.moment.believed = message.value;
  };
  handlers.status = [&pages](core::Stamp, const auto& message) {
    pages.moment.status = message.value;
    if (pages.simulated) return;
    pages.moment.shown = pages.moment.believed;
    pages.add_frame();
  };
  handlers.truth = [&pages](core::Stamp, const auto& message) {
    pages.moment.shown = message.value.state;
    pages.moment.ground = message.value.ground;
    pages.moment.tau = message.value.tau;
    pages.add_frame();
  };
  handlers.terrain = [&pages](core::Stamp now, const auto& message) {
    pages.moment.stance = {message.value.p_WS, message.value.heading};
    pages.add_happening(terrain_json(now, message.value));
  };
  handlers.target = [&pages](core::Stamp now, const auto& message) {
    pages.add_happening(choice_json(now, message.value, pages.moment.stance));
  };
  handlers.plan = [&pages](core::Stamp now, const auto& message) {
    pages.add_happening(plan_json(now, message.value));
  };
  handlers.map = [&pages](core::Stamp now, const auto& message) {
    pages.add_happening(map_json(now, message.value));
  };
  handlers.ack = [&pages](core::Stamp now, const auto& message) {
    pages.add_happening(ack_json(now, message.value));
  };
  return handlers;
}

void WebStory::finish(std::string result) {
  const std::lock_guard lock(pages_->mutex);
  pages_->header.live = false;
  pages_->header.result = std::move(result);
}

std::string WebStory::about() const {
  const std::lock_guard lock(pages_->mutex);
  const Header& header = pages_->header;
  return "{\"run_id\":\"" + header.run_id + "\",\"scenario\":" + quoted_json(header.scenario) +
         ",\"live\":" + (header.live ? "true" : "false") + ",\"columns\":" + frame_columns_json() +
         ",\"robot\":" + robot_json(pages_->robot) + ",\"scene\":" + pages_->scene + "}";
}

std::string WebStory::since(std::size_t frame, std::size_t happening) const {
  const std::lock_guard lock(pages_->mutex);
  const auto join = [](const std::vector<std::string>& list, std::size_t from, std::size_t to) {
    std::string text = "[";
    for (std::size_t i = from; i < to; ++i) text += (i > from ? "," : "") + list[i];
    return text + "]";
  };
  const Pages& pages = *pages_;
  const std::size_t end = std::min(pages.frames.size(), frame + kMostFrames);
  const std::string result = pages.header.result.empty() ? "null" : pages.header.result;
  return "{\"live\":" + std::string(pages.header.live ? "true" : "false") +
         ",\"total\":" + std::to_string(pages.frames.size()) +
         ",\"frames\":" + join(pages.frames, std::min(frame, end), end) + ",\"happenings\":" +
         join(pages.happenings, std::min(happening, pages.happenings.size()),
              pages.happenings.size()) +
         ",\"result\":" + result + "}";
}

}  // namespace hopscotch::apps
