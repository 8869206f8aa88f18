#include "hardware/can_interface.hpp"

#include <linux/can/netlink.h>
#include <linux/if.h>
#include <linux/if_arp.h>
#include <linux/rtnetlink.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <span>
#include <stdexcept>

namespace hopscotch::hardware {
namespace {

constexpr unsigned kAttributeTypes = 64;
using Attributes = std::array<const rtattr*, kAttributeTypes>;

constexpr std::size_t kHeaderSize = RTA_LENGTH(0);

const char* payload(const rtattr* attribute) {
  return reinterpret_cast<const char*>(attribute) + kHeaderSize;
}

/// The attributes of a nest or message by their type.
Attributes attributes_of(const void* first, std::size_t length) {
  Attributes found{};
  std::size_t offset = 0;
  while (length - offset >= sizeof(rtattr)) {
    const auto* at = reinterpret_cast<const rtattr*>(static_cast<const char*>(first) + offset);
    if (at->rta_len < sizeof(rtattr) || at->rta_len > length - offset) break;
    constexpr unsigned kTypeMask = 0x3FFF;  // NLA_TYPE_MASK, which is signed
    const unsigned type = at->rta_type & kTypeMask;
    if (type < kAttributeTypes) found[type] = at;
    offset = std::min<std::size_t>(offset + RTA_ALIGN(at->rta_len), length);
  }
  return found;
}

Attributes nested(const rtattr* nest) {
  if (nest == nullptr) return {};
  return attributes_of(payload(nest), nest->rta_len - kHeaderSize);
}

template <typename Value>
std::optional<Value> value_of(const rtattr* attribute) {
  if (attribute == nullptr || attribute->rta_len < kHeaderSize + sizeof(Value)) return std::nullopt;
  Value value{};
  std::memcpy(&value, payload(attribute), sizeof value);
  return value;
}

std::string text_of(const rtattr* attribute) {
  if (attribute == nullptr) return "";
  return std::string(payload(attribute),
                     strnlen(payload(attribute), attribute->rta_len - kHeaderSize));
}

void read_controller(const Attributes& data, CanInterface& found) {
  if (const auto timing = value_of<can_bittiming>(data[IFLA_CAN_BITTIMING])) {
    constexpr double kPerMille = 1e-3;
    found.bit_rate = timing->bitrate;
    found.sample_point = kPerMille * timing->sample_point;
  }
  if (const auto state = value_of<std::uint32_t>(data[IFLA_CAN_STATE])) {
    if (*state <= CAN_STATE_SLEEPING) found.state = static_cast<CanState>(*state);
  }
  if (const auto restart = value_of<std::uint32_t>(data[IFLA_CAN_RESTART_MS])) {
    found.restart_ms = static_cast<int>(*restart);
  }
  if (const auto errors = value_of<can_berr_counter>(data[IFLA_CAN_BERR_COUNTER])) {
    found.send_errors = errors->txerr;
    found.receive_errors = errors->rxerr;
  }
}

std::optional<CanInterface> read_link(const nlmsghdr* message) {
  const auto* link =
      reinterpret_cast<const ifinfomsg*>(reinterpret_cast<const char*>(message) + NLMSG_LENGTH(0));
  if (link->ifi_type != ARPHRD_CAN) return std::nullopt;
  const std::size_t before = NLMSG_LENGTH(NLMSG_ALIGN(sizeof(ifinfomsg)));
  if (message->nlmsg_len < before) return std::nullopt;
  const Attributes attributes =
      attributes_of(reinterpret_cast<const char*>(message) + before, message->nlmsg_len - before);
  CanInterface found;
  found.name = text_of(attributes[IFLA_IFNAME]);
  found.up = (link->ifi_flags & IFF_UP) != 0;
  found.queue_length =
      static_cast<int>(value_of<std::uint32_t>(attributes[IFLA_TXQLEN]).value_or(0));
  constexpr std::uint32_t kFlexibleMtu = 72;
  found.flexible_data_rate =
      value_of<std::uint32_t>(attributes[IFLA_MTU]).value_or(0) >= kFlexibleMtu;
  const Attributes info = nested(attributes[IFLA_LINKINFO]);
  found.kind = text_of(info[IFLA_INFO_KIND]);
  if (found.kind == "can") read_controller(nested(info[IFLA_INFO_DATA]), found);
  return found;
}

/// Closes what it holds.
struct Descriptor {
  int number;
  ~Descriptor() {
    if (number >= 0) close(number);
  }
};

void ask_for_links(int socket_descriptor) {
  struct {
    nlmsghdr header;
    ifinfomsg link;
  } request{};
  request.header.nlmsg_len = sizeof request;
  request.header.nlmsg_type = RTM_GETLINK;
  request.header.nlmsg_flags = NLM_F_REQUEST | NLM_F_DUMP;
  if (send(socket_descriptor, &request, sizeof request, 0) != sizeof request) {
    throw std::runtime_error("netlink: the kernel takes no question");
  }
}

}  // namespace

std::string can_state_name(CanState state) {
  switch (state) {
    case CanState::active: return "error-active";
    case CanState::warning: return "error-warning";
    case CanState::passive: return "error-passive";
    case CanState::bus_off: return "bus-off";
    case CanState::stopped: return "stopped";
    case CanState::sleeping: return "sleeping";
  }
  return "unknown";
}

std::vector<CanInterface> can_interfaces() {
  const Descriptor netlink{socket(AF_NETLINK, SOCK_RAW | SOCK_CLOEXEC, NETLINK_ROUTE)};
  if (netlink.number < 0) throw std::runtime_error("netlink: no socket");
  ask_for_links(netlink.number);
  std::vector<CanInterface> found;
  std::vector<char> buffer(1 << 16);
  while (true) {
    const ssize_t got = recv(netlink.number, buffer.data(), buffer.size(), 0);
    if (got <= 0) throw std::runtime_error("netlink: the kernel does not answer");
    const auto size = static_cast<std::size_t>(got);
    std::size_t offset = 0;
    while (size - offset >= sizeof(nlmsghdr)) {
      const auto* message = reinterpret_cast<const nlmsghdr*>(buffer.data() + offset);
      if (message->nlmsg_len < sizeof(nlmsghdr) || message->nlmsg_len > size - offset) break;
      offset = std::min<std::size_t>(offset + NLMSG_ALIGN(message->nlmsg_len), size);
      if (message->nlmsg_type == NLMSG_DONE || message->nlmsg_type == NLMSG_ERROR) {
        std::sort(found.begin(), found.end(),
                  [](const auto& a, const auto& b) { return a.name < b.name; });
        return found;
      }
      if (message->nlmsg_type != RTM_NEWLINK) continue;
      if (const auto link = read_link(message)) found.push_back(*link);
    }
  }
}

bool is_virtual(const std::vector<CanInterface>& interfaces, const std::string& name) {
  return std::any_of(interfaces.begin(), interfaces.end(), [&](const CanInterface& interface) {
    return interface.name == name && interface.kind == "vcan";
  });
}

}  // namespace hopscotch::hardware
