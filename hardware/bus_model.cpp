#include "hardware/bus_model.hpp"

#include <algorithm>

namespace hopscotch::hardware {
namespace {

constexpr int kPassiveAbove = 127;
constexpr int kOffAbove = 255;
constexpr int kErrorStep = 8;       // per destroyed frame
constexpr int kErrorBits = 17 + 3;  // flag, delimiter, pause

/// Bits of a frame as they go over the wire before stuffing, with the running checksum.
class BitStream {
 public:
  void add(std::uint32_t value, int count) {
    for (int i = count - 1; i >= 0; --i) add_bit((value >> i) & 1U);
  }
  void add_checksum() {
    const std::uint32_t sum = checksum_;
    add(sum, 15);
  }
  /// So far, stuffed: after five equal bits one of the other kind goes in and counts for the next
  /// run.
  [[nodiscard]] int stuffed() const { return bits_ + stuff_; }

 private:
  void add_bit(std::uint32_t bit) {
    constexpr std::uint32_t kPolynomial = 0x4599;
    const std::uint32_t next = bit ^ ((checksum_ >> 14) & 1U);
    checksum_ = (checksum_ << 1) & 0x7FFFU;
    if (next != 0) checksum_ ^= kPolynomial;
    ++bits_;
    run_ = bit == last_ ? run_ + 1 : 1;
    last_ = bit;
    if (run_ == 5) {
      ++stuff_;
      last_ = 1U - bit;
      run_ = 1;
    }
  }

  std::uint32_t checksum_ = 0;
  std::uint32_t last_ = 2;  // neither
  int run_ = 0;
  int bits_ = 0;
  int stuff_ = 0;
};

core::Stamp later(core::Stamp a, core::Stamp b) {
  return a < b ? b : a;
}

}  // namespace

int frame_bits(const CanFrame& frame) {
  BitStream stream;
  stream.add(0, 1);  // start
  stream.add(frame.id, 11);
  stream.add(0, 3);  // data frame, standard identifier, reserved
  stream.add(frame.size, 4);
  for (std::size_t i = 0; i < frame.size; ++i) stream.add(frame.data[i], 8);
  stream.add_checksum();
  constexpr int kTail = 1 + 1 + 1 + 7 + 3;  // delimiters, acknowledge, end, pause
  return stream.stuffed() + kTail;
}

BusModel::BusModel(const BusSetup& setup, const BusModelOptions& options)
    : setup_(setup), options_(options), random_(options.seed * 2 + 1) {}

std::size_t BusModel::send(std::span<const CanFrame> frames) {
  std::size_t taken = 0;
  for (const CanFrame& frame : frames) {
    if (bus_off_ || host_.size() >= options_.queue) break;
    host_.push_back({now_, frame});
    ++taken;
  }
  return taken;
}

std::size_t BusModel::receive(std::span<CanEvent> events) {
  const std::size_t count = std::min(events.size(), events_.size());
  std::copy_n(events_.begin(), count, events.begin());
  events_.erase(events_.begin(), events_.begin() + static_cast<std::ptrdiff_t>(count));
  return count;
}

CanPort BusModel::host_port() {
  return {.send = [this](std::span<const CanFrame> frames) { return send(frames); },
          .receive = [this](std::span<CanEvent> events) { return receive(events); }};
}

void BusModel::advance(core::Stamp until, const Drives& drives) {
  while (now_ < until && !bus_off_) {
    core::Stamp first = until;
    for (const Waiting& answer : answers_) first = std::min(first, answer.since);
    if (!host_.empty()) first = std::min(first, host_.front().since);
    if (first >= until) break;
    now_ = later(now_, first);
    if (now_ >= until) break;
    transmit_next(drives);
  }
  // A frame under way at `until` has ended a little later; the next one starts from there.
  now_ = later(now_, until);
}

void BusModel::transmit_next(const Drives& drives) {
  const bool host_waits = !host_.empty() && host_.front().since <= now_;
  std::uint32_t lowest = host_waits ? host_.front().frame.id : 0xFFFF;
  for (const Waiting& answer : answers_) {
    if (answer.since <= now_) lowest = std::min(lowest, answer.frame.id);
  }
  const bool from_host = host_waits && host_.front().frame.id == lowest;
  const auto is_winner = [&](const Waiting& answer) {
    return answer.since <= now_ && answer.frame.id == lowest;
  };
  const auto winner = std::find_if(answers_.begin(), answers_.end(), is_winner);
  const CanFrame frame = from_host ? host_.front().frame : winner->frame;
  const FrameTime flexible = frame_time(setup_, frame.size);
  const double time =
      setup_.data_bit_rate > 0.0 ? flexible.most : frame_bits(frame) / setup_.bit_rate;
  // Two drives with one identifier both win and destroy each other's data.
  const auto rivals = std::count_if(answers_.begin(), answers_.end(), is_winner);
  const bool collision = rivals > 1;
  const bool destroyed = collision || noise() || (from_host && cut_);
  busy_ += time;
  now_ = now_.after(destroyed ? time + kErrorBits / setup_.bit_rate : time);
  if (from_host) {
    destroyed ? destroy_host_frame() : end_of_host_frame(frame, drives);
    return;
  }
  answers_.erase(std::remove_if(answers_.begin(), answers_.end(), is_winner), answers_.end());
  if (destroyed || cut_) return;
  if (answers_to_lose_ > 0) {
    --answers_to_lose_;
    return;
  }
  events_.push_back(
      {.kind = CanEvent::Kind::received, .frame = frame, .errors = {}, .stamp = now_});
}

void BusModel::end_of_host_frame(const CanFrame& frame, const Drives& drives) {
  host_.pop_front();
  send_errors_ = std::max(0, send_errors_ - 1);
  events_.push_back(
      {.kind = CanEvent::Kind::confirmed, .frame = frame, .errors = {}, .stamp = now_});
  for (const CanFrame& answer : drives(frame, now_)) answers_.push_back({now_, answer});
}

void BusModel::destroy_host_frame() {
  const bool was_passive = send_errors_ > kPassiveAbove;
  // A passive controller that gets no acknowledge does not count further: it is alone.
  if (!(cut_ && was_passive)) send_errors_ += kErrorStep;
  BusErrors errors;
  errors.no_acknowledge = cut_;
  errors.protocol = !cut_;
  errors.passive = send_errors_ > kPassiveAbove;
  if (errors.passive != was_passive || !errors.passive) report(errors);
  if (send_errors_ > kOffAbove) force_bus_off();
}

void BusModel::force_bus_off() {
  bus_off_ = true;
  host_.clear();
  report({.bus_off = true});
}

void BusModel::report(const BusErrors& errors) {
  events_.push_back({.kind = CanEvent::Kind::error, .frame = {}, .errors = errors, .stamp = now_});
}

/// Knuth's linear congruential generator: noise needs no better one.
bool BusModel::noise() {
  random_ = random_ * 6364136223846793005ULL + 1442695040888963407ULL;
  return static_cast<double>(random_ >> 11U) * 0x1.0p-53 < options_.error_share;
}

}  // namespace hopscotch::hardware
