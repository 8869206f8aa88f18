#pragma once

#include <cstddef>
#include <deque>
#include <filesystem>

#include "msgs/event.hpp"

namespace hopscotch::apps {

/// Remembers the last seconds of what it is given, to be written when something went wrong, even
/// where no log is kept. One thread.
class BlackBox {
 public:
  static constexpr double kSeconds = 20.0;
  static constexpr std::size_t kMostBytes = std::size_t{64} << 20U;

  void remember(const msgs::Event& event);

  /// The remembered events as a log.
  /// @param scene Stands first: a run tells it once, which may be long ago.
  /// @throws std::runtime_error if the disk refuses.
  void write(const std::filesystem::path& file, const msgs::Event& scene) const;

  [[nodiscard]] std::size_t size() const { return events_.size(); }
  [[nodiscard]] std::size_t bytes() const { return bytes_; }

 private:
  std::deque<msgs::Event> events_;
  std::size_t bytes_ = 0;
};

}  // namespace hopscotch::apps
