#pragma once

#include <string_view>

#include "perception/point_cloud.hpp"

namespace hopscotch::perception {

/// The vertices of a PLY file (version 1.0; text or binary) from its bytes. Sizes are checked
/// against the bytes that are there before anything is allocated for them. Points may hold
/// anything.
/// @throws MalformedCloud if the header is none or the data are cut short.
[[nodiscard]] PointCloud read_ply(std::string_view bytes);

}  // namespace hopscotch::perception
