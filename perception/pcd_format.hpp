#pragma once

#include <string_view>

#include "perception/point_cloud.hpp"

namespace hopscotch::perception {

/// A PCD file (version 0.7; text, binary or compressed) from its bytes. Sizes are checked against
/// the bytes that are there before anything is allocated for them. Points may hold anything.
/// @throws MalformedCloud if the header is none or the data are cut short.
[[nodiscard]] PointCloud read_pcd(std::string_view bytes);

}  // namespace hopscotch::perception
