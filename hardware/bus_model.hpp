#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "hardware/bus_topology.hpp"
#include "hardware/can_port.hpp"

namespace hopscotch::hardware {

struct BusModelOptions {
  std::size_t queue = 16;    ///< Frames that the host's interface keeps (txqueuelen).
  double error_share = 0.0;  ///< Frames destroyed by noise.
  std::uint64_t seed = 1;    ///< Of the noise.
};

/// A wire in simulated time, with what a virtual bus lacks: frames take their time to the bit,
/// the lowest identifier wins, noise destroys frames, error counters rise to passive and bus-off.
/// The host's controller sends a destroyed frame again; the drives' do not, so an answer is lost.
/// Allocates: for emulation, not for the control tick.
class BusModel {
 public:
  /// Hears a frame of the host at the moment of its end and may answer.
  using Drives = std::function<std::vector<CanFrame>(const CanFrame&, core::Stamp)>;

  BusModel(const BusSetup& setup, const BusModelOptions& options);

  /// The host's side, as `CanPort::send` and `CanPort::receive`; frames given wait from `now` on.
  std::size_t send(std::span<const CanFrame> frames);
  std::size_t receive(std::span<CanEvent> events);
  /// Refers to this object.
  [[nodiscard]] CanPort host_port();

  /// Lets the wire work until `until`; what is not through by then goes on with the next call.
  void advance(core::Stamp until, const Drives& drives);

  void set_error_share(double share) { options_.error_share = share; }
  /// The next answers of drives vanish.
  void lose_answers(int count) { answers_to_lose_ += count; }
  /// A cut wire: nobody acknowledges, so the host repeats its first frame for ever.
  void cut() { cut_ = true; }
  /// The interface takes nothing more, as when its queue is full (ENOBUFS).
  void fill_queue() { options_.queue = 0; }
  void force_bus_off();

  [[nodiscard]] bool bus_off() const { return bus_off_; }
  /// Of the host's controller, as in the CAN standard: passive above 127, off above 255.
  [[nodiscard]] int send_error_counter() const { return send_errors_; }
  /// Time on the wire so far [s].
  [[nodiscard]] double busy() const { return busy_; }

 private:
  struct Waiting {
    core::Stamp since;
    CanFrame frame;
  };
  void transmit_next(const Drives& drives);
  void end_of_host_frame(const CanFrame& frame, const Drives& drives);
  void destroy_host_frame();
  void report(const BusErrors& errors);
  [[nodiscard]] bool noise();

  BusSetup setup_;
  BusModelOptions options_;
  core::Stamp now_;
  std::deque<Waiting> host_;
  std::vector<Waiting> answers_;
  std::deque<CanEvent> events_;
  int send_errors_ = 0;
  int answers_to_lose_ = 0;
  bool cut_ = false;
  bool bus_off_ = false;
  double busy_ = 0.0;
  std::uint64_t random_;
};

/// Bits of a classical frame on the wire with the pause after it, stuff bits counted one by one
/// from the frame's own identifier, data and checksum.
[[nodiscard]] int frame_bits(const CanFrame& frame);

}  // namespace hopscotch::hardware
