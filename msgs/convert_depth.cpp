#include <zstd.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "hopscotch_msgs/depth.hpp"
#include "msgs/convert.hpp"
#include "msgs/wire.hpp"
#include "msgs/wire_state.hpp"

namespace hopscotch::msgs {

namespace {

constexpr std::int64_t kPixelsMax = std::int64_t{4096} * 4096;
/// Speed counts: a frame is written within the time of a tick or two.
constexpr int kLevel = 1;
constexpr float kMillimetre = 0.001F;
constexpr float kTenth = 0.0001F;
constexpr float kUnitsMax = 65535.0F;

/// Millimetres when all readings are whole ones, as sensors give them; else tenths.
float unit_of(const std::vector<float>& depth) {
  const bool whole = std::all_of(depth.begin(), depth.end(), [](float z) {
    if (!(z > 0.0F && z <= kUnitsMax * kMillimetre)) return true;
    return z == kMillimetre * std::round(z / kMillimetre);
  });
  return whole ? kMillimetre : kTenth;
}

/// What cannot be told in units (not a number, negative, too far) is no measurement.
std::uint16_t units(float z, float unit) {
  if (!(z > 0.0F && z <= kUnitsMax * unit)) return 0;
  return static_cast<std::uint16_t>(std::lround(z / unit));
}

/// Differences along rows, low bytes first: runs of alike bytes are what compresses.
std::vector<std::uint8_t> pack(const core::DepthFrame& frame, float unit) {
  const std::size_t pixels = frame.depth.size();
  const std::size_t width = static_cast<std::size_t>(frame.intrinsics.width);
  std::vector<std::uint8_t> bytes(2 * pixels);
  std::uint16_t left = 0;
  for (std::size_t i = 0; i < pixels; ++i) {
    if (i % width == 0) left = 0;
    const std::uint16_t value = units(frame.depth[i], unit);
    const std::uint16_t difference = static_cast<std::uint16_t>(value - left);
    bytes[i] = static_cast<std::uint8_t>(difference & 0xFFU);
    bytes[pixels + i] = static_cast<std::uint8_t>(difference >> 8U);
    left = value;
  }
  return bytes;
}

void unpack(const std::vector<std::uint8_t>& bytes, float unit, core::DepthFrame& frame) {
  const std::size_t pixels = bytes.size() / 2;
  const std::size_t width = static_cast<std::size_t>(frame.intrinsics.width);
  frame.depth.resize(pixels);
  std::uint16_t value = 0;
  for (std::size_t i = 0; i < pixels; ++i) {
    if (i % width == 0) value = 0;
    const unsigned difference = bytes[i] + 256U * bytes[pixels + i];
    value = static_cast<std::uint16_t>(value + difference);
    frame.depth[i] = unit * static_cast<float>(value);
  }
}

bool inflate(const hopscotch_msgs::depth& message, core::DepthFrame& frame) {
  const std::int64_t pixels = std::int64_t{message.width} * message.height;
  if (message.width <= 0 || message.height <= 0 || pixels > kPixelsMax) return false;
  if (!(message.metres_per_unit > 0.0 && message.metres_per_unit <= 1.0)) return false;
  std::vector<std::uint8_t> bytes(2 * static_cast<std::size_t>(pixels));
  const std::size_t size =
      ZSTD_decompress(bytes.data(), bytes.size(), message.data.data(), message.data.size());
  if (ZSTD_isError(size) != 0 || size != bytes.size()) return false;
  unpack(bytes, static_cast<float>(message.metres_per_unit), frame);
  return true;
}

}  // namespace

Bytes encode(const DepthRecord& value, const Tag& tag) {
  const core::DepthFrame& frame = value.frame;
  hopscotch_msgs::depth message{};
  wire::set_header(frame.stamp, tag, message);
  wire::set_header(value.at_exposure.stamp, tag, message.at_exposure);
  wire::put_state(value.at_exposure, message.at_exposure);
  wire::put(Eigen::Vector3d(frame.X_BC.translation()), message.p_BC);
  wire::put(Eigen::Matrix3d(frame.X_BC.linear()), message.R_BC);
  const core::CameraIntrinsics& lens = frame.intrinsics;
  HOPSCOTCH_CHECK(frame.depth.size() ==
                  static_cast<std::size_t>(lens.width) * static_cast<std::size_t>(lens.height));
  message.width = lens.width;
  message.height = lens.height;
  message.fx = lens.fx;
  message.fy = lens.fy;
  message.cx = lens.cx;
  message.cy = lens.cy;
  const float unit = unit_of(frame.depth);
  message.metres_per_unit = static_cast<double>(unit);
  const std::vector<std::uint8_t> bytes = pack(frame, unit);
  message.data.resize(ZSTD_compressBound(bytes.size()));
  const std::size_t size =
      ZSTD_compress(message.data.data(), message.data.size(), bytes.data(), bytes.size(), kLevel);
  HOPSCOTCH_CHECK(ZSTD_isError(size) == 0);
  message.data.resize(size);
  message.byte_count = static_cast<std::int32_t>(size);
  return wire::to_bytes(message);
}

template <>
std::optional<Tagged<DepthRecord>> decode(std::span<const std::uint8_t> bytes) {
  const auto message = wire::from_bytes_with_list<hopscotch_msgs::depth>(bytes);
  if (!message) return std::nullopt;
  DepthRecord value;
  wire::get_state(message->at_exposure, value.at_exposure);
  core::DepthFrame& frame = value.frame;
  frame.stamp = wire::stamp_of(*message);
  Eigen::Vector3d p_BC;
  Eigen::Matrix3d R_BC;
  wire::get(message->p_BC, p_BC);
  wire::get(message->R_BC, R_BC);
  frame.X_BC.translation() = p_BC;
  frame.X_BC.linear() = R_BC;
  frame.intrinsics = {message->width, message->height, message->fx,
                      message->fy,    message->cx,     message->cy};
  if (!inflate(*message, frame)) return std::nullopt;
  return Tagged<DepthRecord>{wire::tag_of(*message), std::move(value)};
}

}  // namespace hopscotch::msgs
