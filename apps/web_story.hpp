#pragma once

#include <cstddef>
#include <memory>
#include <string>

#include "model/robot_parameters.hpp"
#include "msgs/run_log.hpp"

namespace hopscotch::apps {

/// What the page shows of a run, growing while the run goes on. Fed by the same messages from a log
/// and from a live run. One thread writes through `handlers`; any thread reads.
class WebStory {
 public:
  struct Header {
    std::string run_id;
    std::string scenario;
    bool live = false;   ///< Still going on when the page is opened.
    std::string result;  ///< JSON text of `result.json`; empty while there is none.
  };

  WebStory(const model::RobotParameters& robot, const Header& header);
  ~WebStory();
  WebStory(const WebStory&) = delete;
  WebStory& operator=(const WebStory&) = delete;

  /// To be given to a log reader or dispatcher. Valid as long as this object.
  [[nodiscard]] msgs::RunLogHandlers handlers();
  /// The run is over. @param result JSON text of its `result.json`.
  void finish(std::string result);

  /// What does not change: robot, terrain, names of the numbers in a frame. JSON.
  [[nodiscard]] std::string about() const;
  /// Frames and happenings from these places on, at most `kMostFrames` frames. JSON.
  [[nodiscard]] std::string since(std::size_t frame, std::size_t happening) const;

  static constexpr std::size_t kMostFrames = 2000;

 private:
  struct Pages;
  std::unique_ptr<Pages> pages_;
};

}  // namespace hopscotch::apps
