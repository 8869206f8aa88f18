// Checks the source tree against the house rules: check_includes ROOT. Exit 1 names each breach.
#include <algorithm>
#include <array>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <sstream>

#include "tests/lint/source_rules.hpp"

namespace {

namespace fs = std::filesystem;
using hopscotch::lint::SourceFile;
using hopscotch::lint::Violation;

constexpr std::array<const char*, 11> kFolders{"core",    "model",   "perception", "footstep",
                                               "planner", "control", "hardware",   "sim",
                                               "msgs",    "apps",    "tests"};

std::vector<SourceFile> read_tree(const fs::path& root) {
  std::vector<SourceFile> files;
  for (const char* folder : kFolders) {
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(root / folder)) {
      const fs::path& path = entry.path();
      if (path.extension() != ".cpp" && path.extension() != ".hpp") continue;
      std::ostringstream text;
      text << std::ifstream(path, std::ios::binary).rdbuf();
      files.push_back({fs::relative(path, root).generic_string(), text.str()});
    }
  }
  std::sort(files.begin(), files.end(),
            [](const SourceFile& a, const SourceFile& b) { return a.path < b.path; });
  return files;
}

}  // namespace

int main(int argc, char** argv) try {
  if (argc != 2) {
    std::cerr << "usage: check_includes ROOT\n";
    return 2;
  }
  const std::vector<SourceFile> files = read_tree(argv[1]);
  const std::vector<Violation> violations = hopscotch::lint::check_sources(files);
  for (const Violation& violation : violations) {
    std::cerr << violation.path << ':' << violation.line << ": " << violation.rule << '\n';
  }
  std::cout << "check_includes: " << files.size() << " files, " << violations.size()
            << " breaches\n";
  return violations.empty() ? 0 : 1;
} catch (const std::exception& error) {
  std::cerr << "check_includes: " << error.what() << '\n';
  return 2;
}
