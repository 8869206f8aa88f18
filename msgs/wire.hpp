#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <optional>
#include <span>
#include <string>

#include "core/check.hpp"
#include "core/contact_wrenches.hpp"
#include "core/time.hpp"
#include "msgs/convert.hpp"
#include "msgs/messages.hpp"

/// Shared by the convert_*.cpp files; includes no generated code itself.
namespace hopscotch::msgs::wire {

/// Bytes of a generated message.
template <typename Message>
Bytes to_bytes(const Message& message) {
  Bytes bytes(static_cast<std::size_t>(message.getEncodedSize()));
  const int written = message.encode(bytes.data(), 0, static_cast<int>(bytes.size()));
  HOPSCOTCH_CHECK(written == static_cast<int>(bytes.size()));
  return bytes;
}

/// A generated message from bytes; nothing if they do not hold exactly one. Generated code throws
/// on absurd string lengths, which is caught here.
template <typename Message>
std::optional<Message> from_bytes(std::span<const std::uint8_t> bytes) {
  constexpr std::size_t kMostBytes = 1U << 24;  // far above any message, far below int overflow
  if (bytes.size() > kMostBytes) return std::nullopt;
  Message message;
  try {
    const int read = message.decode(bytes.data(), 0, static_cast<int>(bytes.size()));
    if (read != static_cast<int>(bytes.size())) return std::nullopt;
  } catch (const std::exception&) {
    return std::nullopt;
  }
  return message;
}

/// The same for messages whose only list has its length right behind the header: generated code
/// would allocate whatever a damaged length asks for. No element takes less than a byte.
template <typename Message>
std::optional<Message> from_bytes_with_list(std::span<const std::uint8_t> bytes) {
  constexpr std::size_t kLength = 8 + 3 * 8;  // behind fingerprint, stamp, sequence and run id
  if (bytes.size() < kLength + 4) return std::nullopt;
  std::uint32_t length = 0;
  for (std::size_t i = 0; i < 4; ++i) length = 256U * length + bytes[kLength + i];
  if (length > bytes.size()) return std::nullopt;
  return from_bytes<Message>(bytes);
}

template <typename Message>
void set_header(core::Stamp stamp, const Tag& tag, Message& message) {
  message.stamp_ns = stamp.nanoseconds;
  message.sequence = static_cast<std::int64_t>(tag.sequence);
  message.run_id = static_cast<std::int64_t>(tag.run_id);
}

template <typename Message>
core::Stamp stamp_of(const Message& message) {
  return {message.stamp_ns};
}

template <typename Message>
Tag tag_of(const Message& message) {
  return {static_cast<std::uint64_t>(message.sequence), static_cast<std::uint64_t>(message.run_id)};
}

/// Numbers travel as `double`, or as `float` where that is more than anybody can measure.
template <typename Vector, typename Number, std::size_t N>
void put(const Vector& from, Number (&to)[N]) {
  static_assert(Vector::SizeAtCompileTime == N && Vector::IsVectorAtCompileTime);
  for (std::size_t i = 0; i < N; ++i) to[i] = static_cast<Number>(from.data()[i]);
}
template <typename Vector, typename Number, std::size_t N>
void get(const Number (&from)[N], Vector& to) {
  static_assert(Vector::SizeAtCompileTime == N && Vector::IsVectorAtCompileTime);
  std::copy_n(from, N, to.data());
}

/// Matrices travel row by row.
template <typename Number>
void put(const Eigen::Matrix3d& from, Number (&to)[3][3]) {
  for (int row = 0; row < 3; ++row) put(Eigen::Vector3d(from.row(row)), to[row]);
}
template <typename Number>
void get(const Number (&from)[3][3], Eigen::Matrix3d& to) {
  for (int row = 0; row < 3; ++row) {
    Eigen::Vector3d numbers;
    get(from[row], numbers);
    to.row(row) = numbers;
  }
}

/// For any message with members force[2][3] and moment[2][3].
template <typename Message>
void put_wrenches(const core::ContactWrenches& from, Message& to) {
  for (std::size_t leg = 0; leg < from.size(); ++leg) {
    put(from[leg].force, to.force[leg]);
    put(from[leg].moment, to.moment[leg]);
  }
}
template <typename Message>
void get_wrenches(const Message& from, core::ContactWrenches& to) {
  for (std::size_t leg = 0; leg < to.size(); ++leg) {
    get(from.force[leg], to[leg].force);
    get(from.moment[leg], to[leg].moment);
  }
}

/// An enumerator from its number on the wire. @return false if above `last`.
template <typename Enum>
[[nodiscard]] bool get_enum(std::uint8_t number, Enum last, Enum& to) {
  if (number > static_cast<std::uint8_t>(last)) return false;
  to = static_cast<Enum>(number);
  return true;
}
template <typename Enum>
std::uint8_t number_of(Enum value) {
  return static_cast<std::uint8_t>(value);
}

/// Text from the wire up to its first NUL: generated code cannot encode one with more behind it.
inline std::string text_of(const std::string& text) {
  return text.substr(0, text.find('\0'));
}

/// A count from the wire. @return false if negative or above `capacity`.
[[nodiscard]] inline bool get_count(std::int32_t number, std::size_t capacity, std::size_t& to) {
  if (number < 0 || static_cast<std::size_t>(number) > capacity) return false;
  to = static_cast<std::size_t>(number);
  return true;
}

}  // namespace hopscotch::msgs::wire
