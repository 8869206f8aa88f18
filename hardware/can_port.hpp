#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>

#include "core/time.hpp"
#include "hardware/can_frame.hpp"

namespace hopscotch::hardware {

/// What a CAN controller reports about its bus; several can come in one report.
struct BusErrors {
  bool bus_off = false;           ///< The controller has left the bus.
  bool passive = false;           ///< An error counter is above 127.
  bool warning = false;           ///< An error counter is above 95.
  bool overflow = false;          ///< A buffer of the controller ran over.
  bool no_acknowledge = false;    ///< Nobody acknowledged a frame: drives off, or no termination.
  bool protocol = false;          ///< Bit, form or stuff error: wrong bit timing, or noise.
  bool lost_arbitration = false;  ///< Normal on a busy bus.
  bool send_timeout = false;      ///< The controller did not get rid of a frame.
  bool restarted = false;         ///< The controller is back on the bus.

  bool operator==(const BusErrors&) const = default;
};

/// One thing that came from a bus.
struct CanEvent {
  enum class Kind : std::uint8_t {
    received,   ///< A frame of another node.
    confirmed,  ///< A frame of this port has been on the bus.
    error,      ///< `errors` says which.
  };
  Kind kind = Kind::received;
  CanFrame frame;
  BusErrors errors;
  core::Stamp stamp;  ///< By the kernel on arrival; zero where there is none.
};

/// A bus as its user sees it: two functions, so that the same code talks to a socket, to an
/// emulated bus and to a test. Neither blocks, allocates or throws.
struct CanPort {
  /// Hands frames to the bus in this order. @return How many it took; fewer than given means that
  /// the queue is full or the interface is down: the rest is not kept.
  std::function<std::size_t(std::span<const CanFrame>)> send;
  /// Takes what has come, oldest first. @return How many events were written.
  std::function<std::size_t(std::span<CanEvent>)> receive;
};

}  // namespace hopscotch::hardware
