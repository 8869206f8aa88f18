#pragma once

#include <string>

#include "apps/run_folder.hpp"

namespace hopscotch::apps {

/// The picture of the whole crossing as an embedded image; empty if there is none.
[[nodiscard]] std::string embed_crossing_picture(const RunFolder& folder);

/// All key frames as embedded images with their names; empty if there are none. The first ones are
/// taken if there are too many for a page.
[[nodiscard]] std::string embed_key_frames(const RunFolder& folder);

}  // namespace hopscotch::apps
