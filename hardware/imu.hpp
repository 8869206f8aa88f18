#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "core/config_reader.hpp"

namespace hopscotch::hardware {

/// One message of the inertial measurement unit.
struct ImuSample {
  std::uint64_t time_ns = 0;                        ///< By the unit's own clock.
  Eigen::Vector3d rate = Eigen::Vector3d::Zero();   ///< Angular velocity [rad/s].
  Eigen::Vector3d force = Eigen::Vector3d::Zero();  ///< Specific force [m/s^2].
};

/// Bytes of the wire format: VectorNav's binary output of group 1 with the fields TimeStartup,
/// AngularRate and Accel (0x0121): FA 01 21 01, u64 ns, 3 floats rad/s, 3 floats m/s^2, all little
/// endian, then the checksum, big endian.
inline constexpr std::size_t kImuMessageSize = 4 + 8 + 12 + 12 + 2;
[[nodiscard]] std::array<std::uint8_t, kImuMessageSize> encode_imu(
    const ImuSample& sample) noexcept;

/// Finds messages in a stream of bytes that may start anywhere and hold anything. Real-time safe.
class ImuDecoder {
 public:
  /// @return The newest whole message that ends in these bytes, in the unit's own axes.
  std::optional<ImuSample> feed(std::span<const std::uint8_t> bytes) noexcept;

  [[nodiscard]] std::uint64_t messages() const { return messages_; }
  /// Messages with a wrong checksum or with numbers that are not finite.
  [[nodiscard]] std::uint64_t rejected() const { return rejected_; }

 private:
  [[nodiscard]] std::optional<ImuSample> take() noexcept;
  std::array<std::uint8_t, kImuMessageSize> buffer_{};
  std::size_t filled_ = 0;
  std::uint64_t messages_ = 0;
  std::uint64_t rejected_ = 0;
};

/// Where the unit is and how it sits: section `imu` of the bus file.
struct ImuSetup {
  std::string device;                                  ///< e.g. "/dev/ttyUSB0".
  int baud = 0;                                        ///< [bit/s]
  Eigen::Matrix3d R_BI = Eigen::Matrix3d::Identity();  ///< Unit's axes I to trunk axes B.

  /// @throws core::ConfigError; `axes_in_trunk` must be a rotation.
  static ImuSetup load(const core::ConfigReader& section);
};

/// The unit at a serial port (or at the pseudo terminal of an emulation). Owns the descriptor.
class SerialImu {
 public:
  /// @throws std::runtime_error naming the device and what to do.
  explicit SerialImu(const ImuSetup& setup);
  ~SerialImu();
  SerialImu(const SerialImu&) = delete;
  SerialImu& operator=(const SerialImu&) = delete;

  /// The newest message that has come since the last call, in axes of B. Does not block.
  std::optional<ImuSample> poll() noexcept;

  [[nodiscard]] const ImuDecoder& decoder() const { return decoder_; }

 private:
  int descriptor_;
  Eigen::Matrix3d R_BI_;
  ImuDecoder decoder_;
};

/// The far end of a serial line, for an emulated unit: a pseudo terminal under a name of choice.
class SerialImuEnd {
 public:
  /// @param link Made to point to the terminal; one that is there already is replaced if it is a
  /// link. @throws std::runtime_error if that cannot be done.
  explicit SerialImuEnd(const std::string& link);
  ~SerialImuEnd();
  SerialImuEnd(const SerialImuEnd&) = delete;
  SerialImuEnd& operator=(const SerialImuEnd&) = delete;

  /// A full line drops the message, as a real one would lose it.
  void write(const ImuSample& sample) noexcept;

 private:
  int descriptor_;
  std::string link_;
};

}  // namespace hopscotch::hardware
