#include <fcntl.h>
#include <sys/stat.h>
#include <termios.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <stdexcept>
#include <system_error>

#include "hardware/imu.hpp"

namespace hopscotch::hardware {
namespace {

[[noreturn]] void refuse(const std::string& device, const std::string& fix) {
  throw std::runtime_error(device + ": " + std::generic_category().message(errno) +
                           "; fix: " + fix);
}

speed_t speed_of(int baud) {
  switch (baud) {
    case 115200: return B115200;
    case 230400: return B230400;
    case 460800: return B460800;
    case 921600: return B921600;
    default: break;
  }
  throw std::runtime_error("baud " + std::to_string(baud) +
                           ": the unit's rates are 115200, 230400, 460800 and 921600");
}

/// Bytes as they are: no echo, no line editing, no flow control.
void make_raw(int descriptor, int baud) {
  termios line{};
  if (tcgetattr(descriptor, &line) != 0) return;  // a pipe or file: nothing to set
  cfmakeraw(&line);
  line.c_cflag |= CLOCAL | CREAD;
  cfsetispeed(&line, speed_of(baud));
  cfsetospeed(&line, speed_of(baud));
  tcsetattr(descriptor, TCSANOW, &line);
}

}  // namespace

SerialImu::SerialImu(const ImuSetup& setup)
    : descriptor_(open(setup.device.c_str(), O_RDONLY | O_NOCTTY | O_NONBLOCK | O_CLOEXEC)),
      R_BI_(setup.R_BI) {
  if (descriptor_ < 0) {
    refuse(setup.device,
           "plug in the unit, name its device in `imu.device`, add the user to group dialout");
  }
  make_raw(descriptor_, setup.baud);
}

SerialImu::~SerialImu() {
  close(descriptor_);
}

std::optional<ImuSample> SerialImu::poll() noexcept {
  std::array<std::uint8_t, 512> bytes{};
  std::optional<ImuSample> newest;
  constexpr int kReads = 8;  // 100 messages: more than ever wait
  for (int i = 0; i < kReads; ++i) {
    const ssize_t got = read(descriptor_, bytes.data(), bytes.size());
    if (got <= 0) break;
    const auto sample = decoder_.feed({bytes.data(), static_cast<std::size_t>(got)});
    if (sample) newest = sample;
  }
  if (!newest) return newest;
  newest->rate = R_BI_ * newest->rate;
  newest->force = R_BI_ * newest->force;
  return newest;
}

SerialImuEnd::SerialImuEnd(const std::string& link) : descriptor_(-1), link_(link) {
  descriptor_ = posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
  if (descriptor_ < 0 || grantpt(descriptor_) != 0 || unlockpt(descriptor_) != 0) {
    refuse("/dev/ptmx", "mount devpts");
  }
  std::array<char, 128> name{};
  if (ptsname_r(descriptor_, name.data(), name.size()) != 0) refuse("/dev/ptmx", "mount devpts");
  struct stat found {};
  if (lstat(link.c_str(), &found) == 0 && S_ISLNK(found.st_mode)) unlink(link.c_str());
  if (symlink(name.data(), link.c_str()) != 0) {
    const int reason = errno;
    close(descriptor_);
    errno = reason;
    refuse(link, "name a place in `imu.device` where this user may make a link");
  }
  constexpr int kBaud = 921600;  // of no effect on a pseudo terminal
  make_raw(descriptor_, kBaud);
}

SerialImuEnd::~SerialImuEnd() {
  close(descriptor_);
  unlink(link_.c_str());
}

void SerialImuEnd::write(const ImuSample& sample) noexcept {
  const auto message = encode_imu(sample);
  [[maybe_unused]] const ssize_t written = ::write(descriptor_, message.data(), message.size());
}

}  // namespace hopscotch::hardware
