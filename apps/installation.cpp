#include "apps/installation.hpp"

#include <algorithm>
#include <vector>

#include "core/config_reader.hpp"
#include "hopscotch_version.hpp"

namespace hopscotch::apps {

namespace fs = std::filesystem;

std::string_view program_version() {
  return HOPSCOTCH_VERSION;
}

namespace {

/// `share/hopscotch/<name>` beside an installed program, else `otherwise`.
fs::path shared_directory(const std::string& name, const fs::path& otherwise) {
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  if (!error) {
    fs::path installed = program.parent_path().parent_path() / "share/hopscotch" / name;
    if (fs::is_directory(installed, error)) return installed;
  }
  return otherwise;
}

}  // namespace

fs::path config_directory() {
  return shared_directory("config", HOPSCOTCH_SOURCE_CONFIG_DIR);
}
fs::path page_directory() {
  return shared_directory("web", HOPSCOTCH_BUILT_PAGE_DIR);
}

fs::path robot_file(const std::string& name) {
  const fs::path folder = config_directory() / "robots";
  fs::path file = folder / (name + ".yaml");
  const bool plain = name.find('/') == std::string::npos;
  if (plain && fs::is_regular_file(file)) return file;
  std::vector<std::string> known;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    if (entry.path().extension() == ".yaml") known.push_back(entry.path().stem().string());
  }
  std::sort(known.begin(), known.end());
  std::string list;
  for (const std::string& robot : known) list += (list.empty() ? "" : ", ") + robot;
  throw core::ConfigError(folder.string() + ": there is no robot '" + name + "', but: " + list);
}

}  // namespace hopscotch::apps
