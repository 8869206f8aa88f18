#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "hardware/can_port.hpp"

namespace hopscotch::hardware {

struct CanBusOptions {
  std::string interface_name;              ///< e.g. "can0".
  std::vector<std::uint32_t> identifiers;  ///< Only these 11-bit identifiers are let through.
  bool flexible_data_rate = false;         ///< Send as CAN FD frames with the faster data phase.
};

/// Counts since the socket was opened.
struct CanBusCounters {
  std::uint64_t sent = 0;       ///< Frames that the interface took.
  std::uint64_t confirmed = 0;  ///< Frames that have been on the bus.
  std::uint64_t received = 0;   ///< Frames of others.
  std::uint64_t refused = 0;    ///< Frames not taken: queue full or interface down.
  std::uint64_t dropped = 0;    ///< By the kernel, because the socket's buffer was full.
  std::uint64_t errors = 0;     ///< Error frames.
};

/// One SocketCAN interface: a raw socket that never blocks, with exact filters, error frames,
/// kernel timestamps and confirmation of own frames; one system call per batch each way. Owns the
/// socket. `send` and `receive`: no allocation, lock or exception.
class CanBus {
 public:
  /// @throws std::runtime_error naming the interface, what is wrong and the command that fixes it.
  explicit CanBus(const CanBusOptions& options);
  ~CanBus();
  CanBus(CanBus&&) noexcept;
  CanBus& operator=(CanBus&&) noexcept;

  /// As `CanPort::send`; at most `kBatch` frames are taken per call.
  std::size_t send(std::span<const CanFrame> frames) noexcept;
  /// As `CanPort::receive`; at most `kBatch` events per call.
  std::size_t receive(std::span<CanEvent> events) noexcept;

  /// Reports a bus-off of this bus to everyone who listens: for emulated drives on a virtual bus,
  /// which has no controller of its own. @return Whether the interface took it.
  bool send_bus_off() noexcept;

  [[nodiscard]] const CanBusCounters& counters() const;
  [[nodiscard]] int descriptor() const;  ///< For poll.
  /// Refers to this object, which must outlive it.
  [[nodiscard]] CanPort port();

  static constexpr std::size_t kBatch = 32;

 private:
  struct Socket;
  std::unique_ptr<Socket> socket_;
};

/// What an error frame of Linux says. @param identifier With its flags, as received.
[[nodiscard]] BusErrors decode_bus_errors(std::uint32_t identifier,
                                          std::span<const std::uint8_t, 8> data) noexcept;

}  // namespace hopscotch::hardware
