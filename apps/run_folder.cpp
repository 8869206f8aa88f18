#include "apps/run_folder.hpp"

#include "core/config_reader.hpp"

namespace hopscotch::apps {

void require_run_folder(const RunFolder& folder) {
  for (const std::filesystem::path& file : {folder.result(), folder.log(), folder.robot()}) {
    if (!std::filesystem::is_regular_file(file)) {
      throw core::ConfigError(folder.path.string() +
                              ": is no run folder: " + file.filename().string() + " is missing");
    }
  }
}

}  // namespace hopscotch::apps
