#include "hardware/imu.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <bit>
#include <cmath>

namespace hopscotch::hardware {
namespace {

constexpr std::array<std::uint8_t, 4> kHeader{0xFA, 0x01, 0x21, 0x01};

std::uint16_t add_to_checksum(std::uint16_t sum, std::uint8_t byte) {
  sum = static_cast<std::uint16_t>((sum >> 8U) | (sum << 8U));
  sum = static_cast<std::uint16_t>(sum ^ byte);
  sum = static_cast<std::uint16_t>(sum ^ ((sum & 0xFFU) >> 4U));
  sum = static_cast<std::uint16_t>(sum ^ (sum << 12U));
  return static_cast<std::uint16_t>(sum ^ ((sum & 0x00FFU) << 5U));
}

/// CRC-16/CCITT over everything between the first byte and the checksum.
std::uint16_t checksum(std::span<const std::uint8_t> bytes) {
  std::uint16_t sum = 0;
  for (const std::uint8_t byte : bytes) sum = add_to_checksum(sum, byte);
  return sum;
}

template <typename Bits>
void put(std::span<std::uint8_t> bytes, Bits bits) {
  for (std::size_t i = 0; i < sizeof(Bits); ++i) {
    bytes[i] = static_cast<std::uint8_t>((bits >> (8 * i)) & 0xFFU);
  }
}

template <typename Bits>
Bits get(std::span<const std::uint8_t> bytes) {
  Bits bits = 0;
  for (std::size_t i = 0; i < sizeof(Bits); ++i) bits |= static_cast<Bits>(bytes[i]) << (8 * i);
  return bits;
}

void put_vector(std::span<std::uint8_t> bytes, const Eigen::Vector3d& vector) {
  for (std::size_t i = 0; i < 3; ++i) {
    const auto value = static_cast<float>(vector[static_cast<Eigen::Index>(i)]);
    put(bytes.subspan(4 * i), std::bit_cast<std::uint32_t>(value));
  }
}

Eigen::Vector3d get_vector(std::span<const std::uint8_t> bytes) {
  Eigen::Vector3d vector;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto bits = get<std::uint32_t>(bytes.subspan(4 * i));
    vector[static_cast<Eigen::Index>(i)] = static_cast<double>(std::bit_cast<float>(bits));
  }
  return vector;
}

}  // namespace

std::array<std::uint8_t, kImuMessageSize> encode_imu(const ImuSample& sample) noexcept {
  std::array<std::uint8_t, kImuMessageSize> message{};
  const std::span<std::uint8_t> bytes(message);
  std::copy(kHeader.begin(), kHeader.end(), message.begin());
  put(bytes.subspan(4), sample.time_ns);
  put_vector(bytes.subspan(12), sample.rate);
  put_vector(bytes.subspan(24), sample.force);
  const std::uint16_t sum = checksum(bytes.subspan(1, kImuMessageSize - 3));
  message[kImuMessageSize - 2] = static_cast<std::uint8_t>(sum >> 8U);
  message[kImuMessageSize - 1] = static_cast<std::uint8_t>(sum & 0xFFU);
  return message;
}

std::optional<ImuSample> ImuDecoder::feed(std::span<const std::uint8_t> bytes) noexcept {
  std::optional<ImuSample> newest;
  for (const std::uint8_t byte : bytes) {
    buffer_[filled_++] = byte;
    // What cannot be the start of a message is dropped from the front, so that a message after
    // garbage, even after a false start, is found.
    while (filled_ > 0 && !std::equal(buffer_.begin(),
                                      buffer_.begin() + static_cast<std::ptrdiff_t>(
                                                            std::min(filled_, kHeader.size())),
                                      kHeader.begin())) {
      std::copy(buffer_.begin() + 1, buffer_.begin() + static_cast<std::ptrdiff_t>(filled_),
                buffer_.begin());
      --filled_;
    }
    if (filled_ < kImuMessageSize) continue;
    if (const std::optional<ImuSample> sample = take()) newest = sample;
  }
  return newest;
}

/// Reads the full buffer. After a wrong checksum only its first byte is given up: the true start
/// may lie within.
std::optional<ImuSample> ImuDecoder::take() noexcept {
  const std::span<const std::uint8_t> bytes(buffer_);
  const bool intact = checksum(bytes.subspan(1)) == 0;
  ImuSample sample{.time_ns = get<std::uint64_t>(bytes.subspan(4)),
                   .rate = get_vector(bytes.subspan(12)),
                   .force = get_vector(bytes.subspan(24))};
  if (intact && sample.rate.allFinite() && sample.force.allFinite()) {
    filled_ = 0;
    ++messages_;
    return sample;
  }
  ++rejected_;
  std::copy(buffer_.begin() + 1, buffer_.end(), buffer_.begin());
  --filled_;
  return std::nullopt;
}

ImuSetup ImuSetup::load(const core::ConfigReader& section) {
  ImuSetup setup;
  setup.device = section.text("device");
  setup.baud = section.integer("baud", 9600, 4000000);
  const Eigen::Vector<double, 9> rows = section.vector<9>("axes_in_trunk");
  setup.R_BI = Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(rows.data());
  constexpr double kTolerance = 1e-3;  // written by hand with three digits
  const bool orthogonal = (setup.R_BI * setup.R_BI.transpose()).isIdentity(kTolerance);
  if (!orthogonal || setup.R_BI.determinant() < 0.0) {
    section.reject("axes_in_trunk", "must be the nine numbers, row by row, of a rotation");
  }
  section.finish();
  return setup;
}

}  // namespace hopscotch::hardware
