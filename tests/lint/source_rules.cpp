#include "tests/lint/source_rules.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <string_view>

namespace hopscotch::lint {
namespace {

constexpr int kFileLinesMax = 500;
constexpr int kFunctionLinesMax = 60;
constexpr std::size_t kParametersMax = 5;

constexpr std::array<std::string_view, 7> kStages{"perception", "footstep", "planner", "control",
                                                  "hardware",   "sim",      "msgs"};

/// A library and the only places that may include it; a place is a folder or the start of a path.
struct LibraryHome {
  std::string_view prefix;
  std::string_view library;
  std::array<std::string_view, 3> places;
};
constexpr std::array<LibraryHome, 20> kHomes{{
    {"pcl/", "PCL", {"perception/"}},
    {"octomap/", "OctoMap", {"perception/"}},
    {"ceres/", "Ceres", {"perception/"}},
    {"opencv2/", "OpenCV", {"perception/", "sim/", "apps/"}},
    {"coin/", "Ipopt", {"planner/ipopt_problem."}},
    {"coin-or/", "Ipopt", {"planner/ipopt_problem."}},
    {"Ip", "Ipopt", {"planner/ipopt_problem."}},
    {"linux/can", "SocketCAN", {"hardware/", "apps/command_doctor."}},
    {"mujoco/", "MuJoCo", {"sim/"}},
    {"EGL/", "EGL", {"sim/"}},
    {"GL/", "OpenGL", {"sim/"}},
    {"GLFW/", "GLFW", {"sim/", "apps/"}},
    {"lcm/", "LCM", {"msgs/"}},
    {"yaml-cpp/", "yaml-cpp", {"core/config_reader.cpp"}},
    {"sqlite3", "SQLite", {"apps/"}},
    {"nlohmann/", "nlohmann-json", {"apps/"}},
    {"CLI/", "CLI11", {"apps/"}},
    {"httplib.h", "cpp-httplib", {"apps/"}},
    {"gtest/", "GoogleTest", {}},
    {"gmock/", "GoogleTest", {}},
}};

/// Library code gets time, seeds and settings as arguments and gives its answers as values.
constexpr std::array<std::string_view, 13> kForbiddenWords{
    "cout",          "cerr",         "printf",       "fprintf", "puts",
    "getenv",        "system_clock", "steady_clock", "rand",    "high_resolution_clock",
    "clock_gettime", "gettimeofday", "random_device"};
constexpr std::string_view kIpoptFile = "planner/ipopt_problem.";  // signatures are Ipopt's
constexpr std::string_view kCheckHeader = "core/check.hpp";        // reports before it aborts

std::string_view folder_of(std::string_view path) {
  const std::size_t slash = path.find('/');
  return slash == std::string_view::npos ? std::string_view() : path.substr(0, slash);
}

bool is_stage(std::string_view folder) {
  return std::find(kStages.begin(), kStages.end(), folder) != kStages.end();
}

bool is_ours(std::string_view folder) {
  return folder == "core" || folder == "model" || folder == "apps" || is_stage(folder);
}

bool may_include(std::string_view from, std::string_view to) {
  if (from == to || from == "apps" || from == "tests") return true;
  if (to == "core") return true;
  return to == "model" && is_stage(from) && from != "msgs";
}

const LibraryHome* home_of(std::string_view include) {
  for (const LibraryHome& home : kHomes) {
    const bool is_ipopt_prefix = home.prefix == "Ip";  // IpTNLP.hpp, but not Iphone.h
    if (!include.starts_with(home.prefix)) continue;
    if (is_ipopt_prefix && (include.size() < 3 || include[2] < 'A' || include[2] > 'Z')) continue;
    return &home;
  }
  return nullptr;
}

bool lives_there(const LibraryHome& home, std::string_view path) {
  return std::any_of(home.places.begin(), home.places.end(), [&](std::string_view place) {
    return !place.empty() && path.starts_with(place);
  });
}

/// One run over all files.
class Checker {
 public:
  explicit Checker(const std::vector<SourceFile>& files) : files_(files) {
    for (const SourceFile& file : files) includes_[file.path] = includes_of(file);
    for (const SourceFile& file : files) {
      if (file.path.ends_with(".hpp") && shows_library(file.path))
        library_headers_.insert(file.path);
    }
  }

  std::vector<Violation> run() {
    for (const SourceFile& file : files_) {
      const std::string code = code_only(file.text);
      check_includes(file);
      check_sizes(file, code);
      check_words(file, code);
    }
    return std::move(violations_);
  }

 private:
  void report(const SourceFile& file, int line, std::string rule) {
    violations_.push_back({file.path, line, std::move(rule)});
  }

  /// Whether a header includes an external library, itself or through headers of its own folder.
  bool shows_library(const std::string& path) const {
    std::set<std::string> seen;
    std::vector<std::string> open{path};
    while (!open.empty()) {
      const std::string header = open.back();
      open.pop_back();
      const auto found = includes_.find(header);
      if (found == includes_.end() || !seen.insert(header).second) continue;
      for (const Include& include : found->second) {
        if (home_of(include.name) != nullptr) return true;
        if (folder_of(include.name) == folder_of(path)) open.push_back(include.name);
      }
    }
    return false;
  }

  void check_includes(const SourceFile& file) {
    const std::string_view folder = folder_of(file.path);
    if (folder == "tests") return;  // tests may include anything
    for (const Include& include : includes_.at(file.path)) {
      const std::string_view to = folder_of(include.name);
      if (is_ours(to) && !may_include(folder, to)) {
        report(file, include.line, std::string(folder) + " must not include " + std::string(to));
      }
      if (to == "tests") report(file, include.line, "only tests include tests");
      if (to != folder && library_headers_.contains(include.name)) {
        report(file, include.line,
               include.name + " shows an external library, so only its own folder may include it");
      }
      const LibraryHome* home = home_of(include.name);
      if (home != nullptr && !lives_there(*home, file.path)) {
        report(file, include.line, std::string(home->library) + " does not live here");
      }
    }
  }

  void check_sizes(const SourceFile& file, const std::string& code) {
    const auto lines = static_cast<int>(split_lines(file.text).size());
    if (lines > kFileLinesMax) {
      report(file, lines,
             "file of " + std::to_string(lines) + " lines, limit " + std::to_string(kFileLinesMax));
    }
    for (const Function& function : functions_of(code)) {
      const int length = function.last_line - function.first_line + 1;
      if (length > kFunctionLinesMax) {
        report(file, function.first_line,
               "function of " + std::to_string(length) + " lines, limit " +
                   std::to_string(kFunctionLinesMax));
      }
      const bool own_signature = !file.path.starts_with(kIpoptFile);
      if (own_signature && function.parameters.size() > kParametersMax) {
        report(file, function.first_line,
               std::to_string(function.parameters.size()) + " parameters, limit " +
                   std::to_string(kParametersMax));
      }
      check_parameters(file, function);
    }
  }

  void check_parameters(const SourceFile& file, const Function& function) {
    if (folder_of(file.path) == "tests" || file.path.starts_with(kIpoptFile)) return;
    for (const std::string& parameter : function.parameters) {
      if (parameter.starts_with("bool ") || parameter.starts_with("const bool ")) {
        report(file, function.first_line,
               "boolean parameter '" + parameter + "'; use an enum or two functions");
      }
    }
  }

  void check_words(const SourceFile& file, const std::string& code) {
    const std::string_view folder = folder_of(file.path);
    if (folder == "tests" || folder == "apps" || file.path == kCheckHeader) return;
    const std::vector<std::string> lines = split_lines(code);
    for (std::size_t i = 0; i < lines.size(); ++i) {
      for (const std::string_view word : kForbiddenWords) {
        if (has_word(lines[i], word)) {
          report(file, static_cast<int>(i) + 1,
                 std::string(word) +
                     " is not for library code: it reads no clock, seed or "
                     "environment and prints nothing");
        }
      }
    }
  }

  const std::vector<SourceFile>& files_;
  std::map<std::string, std::vector<Include>> includes_;
  std::set<std::string> library_headers_;
  std::vector<Violation> violations_;
};

}  // namespace

std::vector<Violation> check_sources(const std::vector<SourceFile>& files) {
  return Checker(files).run();
}

}  // namespace hopscotch::lint
