#include "perception/lzf.hpp"

#include <cstdint>
#include <utility>

namespace hopscotch::perception {

std::optional<std::string> unpack_lzf(std::string_view packed, std::size_t size) {
  constexpr std::size_t kLiterals = 32;
  constexpr std::size_t kLongLength = 7;
  std::string out;
  out.reserve(size);
  std::size_t at = 0;
  const auto byte = [&] {
    return static_cast<std::size_t>(static_cast<std::uint8_t>(packed[at++]));
  };
  while (at < packed.size()) {
    const std::size_t control = byte();
    if (control < kLiterals) {
      const std::size_t length = control + 1;
      if (length > packed.size() - at || length > size - out.size()) return std::nullopt;
      out.append(packed.substr(at, length));
      at += length;
      continue;
    }
    std::size_t length = control >> 5U;
    if (length == kLongLength) {
      if (at == packed.size()) return std::nullopt;
      length += byte();
    }
    length += 2;
    if (at == packed.size()) return std::nullopt;
    const std::size_t distance = ((control & 31U) << 8U) + byte() + 1;
    if (distance > out.size() || length > size - out.size()) return std::nullopt;
    // Byte by byte: a reference may run into what it writes itself.
    for (std::size_t i = 0; i < length; ++i) out.push_back(out[out.size() - distance]);
  }
  return out.size() == size ? std::optional(std::move(out)) : std::nullopt;
}

}  // namespace hopscotch::perception
