#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace hopscotch::hardware {

/// A classical CAN frame with an 11-bit identifier, as the bus carries it.
struct CanFrame {
  static constexpr std::size_t kMaxSize = 8;
  std::uint32_t id = 0;                       ///< 0 to 0x7FF.
  std::uint8_t size = 0;                      ///< Bytes of data used, 0 to 8.
  std::array<std::uint8_t, kMaxSize> data{};  ///< Those beyond `size` mean nothing.
};

}  // namespace hopscotch::hardware
