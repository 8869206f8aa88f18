#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace hopscotch::perception {

/// Unpacks LZF, the compression of PCD files: a control byte below 32 is followed by one literal
/// more than it says; any other one refers back, its upper three bits the length less two (7: one
/// more byte of length), its lower five with the next byte the distance less one.
/// @param size  Of what was packed [byte]; allocated at once, so check it before.
/// @return nothing when the data are damaged or do not unpack to just that size.
[[nodiscard]] std::optional<std::string> unpack_lzf(std::string_view packed, std::size_t size);

}  // namespace hopscotch::perception
