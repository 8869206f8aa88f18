#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>

namespace hopscotch::core {

/// The latest value from one writing thread to one reading thread. Neither ever waits for the
/// other: three places rotate, so that one is being written, one read, and one holds the newest.
/// Values that are not read in time are overwritten. Copying a `Value` must not allocate or throw
/// where the thread must not.
template <typename Value>
class Mailbox {
 public:
  /// Writing thread.
  void write(const Value& value) noexcept {
    places_[writing_] = value;
    const std::uint8_t before =
        middle_.exchange(static_cast<std::uint8_t>(writing_ | kFresh), std::memory_order_acq_rel);
    writing_ = before & kPlace;
  }

  /// Reading thread. @param[out] value Written only if there is one that was not read yet.
  [[nodiscard]] bool read(Value& value) noexcept {
    if ((middle_.load(std::memory_order_relaxed) & kFresh) == 0) return false;
    const std::uint8_t before = middle_.exchange(reading_, std::memory_order_acq_rel);
    reading_ = before & kPlace;
    value = places_[reading_];
    return true;
  }

 private:
  static constexpr std::uint8_t kFresh = 4;
  static constexpr std::uint8_t kPlace = 3;
  std::array<Value, 3> places_{};
  std::uint8_t writing_ = 0;
  std::uint8_t reading_ = 1;
  std::atomic<std::uint8_t> middle_{2};
};

}  // namespace hopscotch::core
