#include "apps/step_link.hpp"

#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstddef>
#include <cstring>
#include <stdexcept>
#include <system_error>
#include <thread>

namespace hopscotch::apps {

namespace {

struct Address {
  sockaddr_un address{};
  socklen_t size = 0;

  explicit Address(const std::string& name) {
    address.sun_family = AF_UNIX;
    // A leading zero byte makes the name abstract: it leaves no file behind.
    std::memcpy(address.sun_path + 1, name.data(),
                std::min(name.size(), sizeof(address.sun_path) - 1));
    size = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + 1 + name.size());
  }
  [[nodiscard]] const sockaddr* get() const { return reinterpret_cast<const sockaddr*>(&address); }
};

int make_socket() {
  const int descriptor = socket(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0);
  if (descriptor < 0) {
    throw std::runtime_error("socket: " + std::generic_category().message(errno));
  }
  return descriptor;
}

constexpr char kGrant = 'g';

}  // namespace

StepGranter::StepGranter(const std::string& socket_name, double patience)
    : descriptor_(make_socket()) {
  const Address address(socket_name);
  const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(patience);
  while (connect(descriptor_, address.get(), address.size) != 0) {
    if (std::chrono::steady_clock::now() > end) {
      close(descriptor_);
      throw std::runtime_error("lock-step: nobody listens at '" + socket_name +
                               "'; fix: start `hopscotch motors` with the same configuration");
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
}

StepGranter::~StepGranter() {
  close(descriptor_);
}

std::optional<core::Stamp> StepGranter::grant() noexcept {
  if (send(descriptor_, &kGrant, 1, MSG_NOSIGNAL) != 1) return std::nullopt;
  core::Stamp now;
  ssize_t got = 0;
  do {
    got = recv(descriptor_, &now, sizeof now, 0);
  } while (got < 0 && errno == EINTR);
  if (got != sizeof now) return std::nullopt;
  return now;
}

StepFollower::StepFollower(const std::string& socket_name) : listener_(make_socket()) {
  const Address address(socket_name);
  if (bind(listener_, address.get(), address.size) != 0 || listen(listener_, 1) != 0) {
    const int reason = errno;
    close(listener_);
    throw std::runtime_error("lock-step: '" + socket_name +
                             "': " + std::generic_category().message(reason) +
                             "; fix: end the other `hopscotch motors`");
  }
}

StepFollower::~StepFollower() {
  if (robot_ >= 0) close(robot_);
  close(listener_);
}

StepFollower::Event StepFollower::wait(int timeout_ms) {
  pollfd waited{.fd = robot_ >= 0 ? robot_ : listener_, .events = POLLIN, .revents = 0};
  if (poll(&waited, 1, timeout_ms) <= 0) return Event::none;
  if (robot_ < 0) {
    robot_ = accept4(listener_, nullptr, nullptr, SOCK_CLOEXEC);
    return Event::none;
  }
  char grant = 0;
  if (recv(robot_, &grant, 1, 0) == 1) return Event::granted;
  close(robot_);
  robot_ = -1;
  return Event::robot_gone;
}

void StepFollower::done(core::Stamp now) {
  // A robot that has gone meanwhile is noticed by the next wait.
  [[maybe_unused]] const ssize_t sent = send(robot_, &now, sizeof now, MSG_NOSIGNAL);
}

}  // namespace hopscotch::apps
