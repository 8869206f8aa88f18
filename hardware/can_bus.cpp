#include "hardware/can_bus.hpp"

#include <fcntl.h>
#include <linux/can.h>
#include <linux/can/error.h>
#include <linux/can/raw.h>
#include <linux/net_tstamp.h>
#include <net/if.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <system_error>

namespace hopscotch::hardware {
namespace {

// Large enough for what ten drives answer in 100 ms: a host that sleeps longer has faults anyway.
constexpr int kReceiveBuffer = 1 << 20;  // [byte]

[[noreturn]] void refuse(const CanBusOptions& options, const std::string& what,
                         const std::string& fix) {
  throw std::runtime_error(options.interface_name + ": " + what + "; fix: " + fix);
}

void set(int descriptor, int level, int name, const void* value, std::size_t size) {
  if (setsockopt(descriptor, level, name, value, static_cast<socklen_t>(size)) != 0) {
    throw std::runtime_error("socket option " + std::to_string(name) + ": " +
                             std::generic_category().message(errno));
  }
}

void set_flag(int descriptor, int level, int name) {
  constexpr int kOn = 1;
  set(descriptor, level, name, &kOn, sizeof kOn);
}

void set_filters(int descriptor, const CanBusOptions& options) {
  std::vector<can_filter> filters;
  for (const std::uint32_t identifier : options.identifiers) {
    // All three bits in the mask make it an exact match, which the kernel looks up directly.
    filters.push_back({identifier, CAN_EFF_FLAG | CAN_RTR_FLAG | CAN_SFF_MASK});
  }
  set(descriptor, SOL_CAN_RAW, CAN_RAW_FILTER, filters.data(), filters.size() * sizeof filters[0]);
  const can_err_mask_t errors = CAN_ERR_TX_TIMEOUT | CAN_ERR_LOSTARB | CAN_ERR_CRTL | CAN_ERR_PROT |
                                CAN_ERR_ACK | CAN_ERR_BUSOFF | CAN_ERR_BUSERROR | CAN_ERR_RESTARTED;
  set(descriptor, SOL_CAN_RAW, CAN_RAW_ERR_FILTER, &errors, sizeof errors);
}

int open_socket(const CanBusOptions& options) {
  const int descriptor = socket(PF_CAN, SOCK_RAW | SOCK_CLOEXEC | SOCK_NONBLOCK, CAN_RAW);
  if (descriptor < 0) refuse(options, "the kernel has no CAN", "modprobe can_raw");
  const unsigned index = if_nametoindex(options.interface_name.c_str());
  sockaddr_can address{};
  address.can_family = AF_CAN;
  address.can_ifindex = static_cast<int>(index);
  if (index == 0 ||
      bind(descriptor, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) {
    close(descriptor);
    refuse(options, "no such CAN interface",
           "ip link set " + options.interface_name +
               " up type can bitrate 1000000 restart-ms 0, or ip link add dev " +
               options.interface_name + " type vcan");
  }
  return descriptor;
}

core::Stamp stamp_of(const timespec& time) {
  return {static_cast<std::int64_t>(time.tv_sec) * 1'000'000'000 + time.tv_nsec};
}

}  // namespace

/// Everything the system calls need, made once. A classical frame is the front of an FD frame, so
/// one buffer serves both.
struct CanBus::Socket {
  static constexpr std::size_t kControlSize = 128;
  int descriptor = -1;
  bool flexible_data_rate = false;
  CanBusCounters counters;
  std::array<canfd_frame, kBatch> frames{};
  std::array<iovec, kBatch> vectors{};
  std::array<mmsghdr, kBatch> messages{};
  std::array<std::array<char, kControlSize>, kBatch> control{};

  explicit Socket(const CanBusOptions& options)
      : descriptor(open_socket(options)), flexible_data_rate(options.flexible_data_rate) {
    set_filters(descriptor, options);
    set_flag(descriptor, SOL_CAN_RAW, CAN_RAW_RECV_OWN_MSGS);
    set_flag(descriptor, SOL_SOCKET, SO_RXQ_OVFL);
    if (flexible_data_rate) set_flag(descriptor, SOL_CAN_RAW, CAN_RAW_FD_FRAMES);
    constexpr int kStamps = SOF_TIMESTAMPING_RX_SOFTWARE | SOF_TIMESTAMPING_SOFTWARE;
    set(descriptor, SOL_SOCKET, SO_TIMESTAMPING, &kStamps, sizeof kStamps);
    set(descriptor, SOL_SOCKET, SO_RCVBUF, &kReceiveBuffer, sizeof kReceiveBuffer);
  }
  ~Socket() {
    if (descriptor >= 0) close(descriptor);
  }
  Socket(const Socket&) = delete;
  Socket& operator=(const Socket&) = delete;

  void prepare(std::size_t count, std::size_t size) {
    for (std::size_t i = 0; i < count; ++i) {
      vectors[i] = {&frames[i], size};
      messages[i] = {};
      messages[i].msg_hdr.msg_iov = &vectors[i];
      messages[i].msg_hdr.msg_iovlen = 1;
    }
  }
  CanEvent event(std::size_t i);
  void read_control(msghdr& header, CanEvent& event);
};

CanEvent CanBus::Socket::event(std::size_t i) {
  CanEvent event;
  const canfd_frame& frame = frames[i];
  msghdr& header = messages[i].msg_hdr;
  read_control(header, event);
  if ((frame.can_id & CAN_ERR_FLAG) != 0) {
    ++counters.errors;
    event.kind = CanEvent::Kind::error;
    event.errors = decode_bus_errors(frame.can_id, std::span<const std::uint8_t, 8>(frame.data, 8));
    return event;
  }
  const bool own = (header.msg_flags & MSG_CONFIRM) != 0;
  ++(own ? counters.confirmed : counters.received);
  event.kind = own ? CanEvent::Kind::confirmed : CanEvent::Kind::received;
  event.frame.id = frame.can_id & CAN_SFF_MASK;
  event.frame.size =
      static_cast<std::uint8_t>(std::min<std::size_t>(frame.len, CanFrame::kMaxSize));
  std::copy_n(std::begin(frame.data), CanFrame::kMaxSize, event.frame.data.begin());
  return event;
}

void CanBus::Socket::read_control(msghdr& header, CanEvent& event) {
  for (cmsghdr* part = CMSG_FIRSTHDR(&header); part != nullptr; part = CMSG_NXTHDR(&header, part)) {
    if (part->cmsg_level != SOL_SOCKET) continue;
    if (part->cmsg_type == SO_TIMESTAMPING) {
      timespec time{};
      std::memcpy(&time, CMSG_DATA(part), sizeof time);  // the first of three is the software's
      event.stamp = stamp_of(time);
    } else if (part->cmsg_type == SO_RXQ_OVFL) {
      std::uint32_t dropped = 0;
      std::memcpy(&dropped, CMSG_DATA(part), sizeof dropped);
      counters.dropped = dropped;
    }
  }
}

CanBus::CanBus(const CanBusOptions& options) : socket_(std::make_unique<Socket>(options)) {}
CanBus::~CanBus() = default;
CanBus::CanBus(CanBus&&) noexcept = default;
CanBus& CanBus::operator=(CanBus&&) noexcept = default;

std::size_t CanBus::send(std::span<const CanFrame> frames) noexcept {
  Socket& s = *socket_;
  const std::size_t count = std::min(frames.size(), kBatch);
  for (std::size_t i = 0; i < count; ++i) {
    canfd_frame& out = s.frames[i];
    out = {};
    out.can_id = frames[i].id & CAN_SFF_MASK;
    out.len = frames[i].size;
    out.flags = s.flexible_data_rate ? CANFD_BRS : 0;
    std::copy_n(frames[i].data.begin(), CanFrame::kMaxSize, std::begin(out.data));
  }
  s.prepare(count, s.flexible_data_rate ? CANFD_MTU : CAN_MTU);
  const int taken =
      sendmmsg(s.descriptor, s.messages.data(), static_cast<unsigned>(count), MSG_DONTWAIT);
  const std::size_t sent = taken > 0 ? static_cast<std::size_t>(taken) : 0;
  s.counters.sent += sent;
  s.counters.refused += frames.size() - sent;
  return sent;
}

std::size_t CanBus::receive(std::span<CanEvent> events) noexcept {
  Socket& s = *socket_;
  const std::size_t count = std::min(events.size(), kBatch);
  s.prepare(count, sizeof(canfd_frame));
  for (std::size_t i = 0; i < count; ++i) {
    s.messages[i].msg_hdr.msg_control = s.control[i].data();
    s.messages[i].msg_hdr.msg_controllen = Socket::kControlSize;
  }
  const int got = recvmmsg(s.descriptor, s.messages.data(), static_cast<unsigned>(count),
                           MSG_DONTWAIT, nullptr);
  const std::size_t received = got > 0 ? static_cast<std::size_t>(got) : 0;
  for (std::size_t i = 0; i < received; ++i) events[i] = s.event(i);
  return received;
}

bool CanBus::send_bus_off() noexcept {
  can_frame frame{};
  frame.can_id = CAN_ERR_FLAG | CAN_ERR_BUSOFF;
  frame.can_dlc = CAN_ERR_DLC;
  return write(socket_->descriptor, &frame, sizeof frame) == sizeof frame;
}

const CanBusCounters& CanBus::counters() const {
  return socket_->counters;
}

int CanBus::descriptor() const {
  return socket_->descriptor;
}

CanPort CanBus::port() {
  return {.send = [this](std::span<const CanFrame> frames) { return send(frames); },
          .receive = [this](std::span<CanEvent> events) { return receive(events); }};
}

BusErrors decode_bus_errors(std::uint32_t identifier,
                            std::span<const std::uint8_t, 8> data) noexcept {
  BusErrors errors;
  errors.bus_off = (identifier & CAN_ERR_BUSOFF) != 0;
  errors.no_acknowledge = (identifier & CAN_ERR_ACK) != 0;
  errors.protocol = (identifier & (CAN_ERR_PROT | CAN_ERR_BUSERROR)) != 0;
  errors.lost_arbitration = (identifier & CAN_ERR_LOSTARB) != 0;
  errors.send_timeout = (identifier & CAN_ERR_TX_TIMEOUT) != 0;
  errors.restarted = (identifier & CAN_ERR_RESTARTED) != 0;
  if ((identifier & CAN_ERR_CRTL) != 0) {
    const std::uint8_t controller = data[1];
    errors.overflow = (controller & (CAN_ERR_CRTL_RX_OVERFLOW | CAN_ERR_CRTL_TX_OVERFLOW)) != 0;
    errors.warning = (controller & (CAN_ERR_CRTL_RX_WARNING | CAN_ERR_CRTL_TX_WARNING)) != 0;
    errors.passive = (controller & (CAN_ERR_CRTL_RX_PASSIVE | CAN_ERR_CRTL_TX_PASSIVE)) != 0;
  }
  return errors;
}

}  // namespace hopscotch::hardware
