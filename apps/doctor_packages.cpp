#include "apps/doctor_packages.hpp"

#include <link.h>

#include <Eigen/Core>
#include <array>
#include <filesystem>
#include <iterator>
#include <map>
#include <string>
#include <string_view>

#include "apps/campaign/external_command.hpp"

namespace hopscotch::apps {

namespace fs = std::filesystem;

namespace {

struct Library {
  const char* name;
  std::string_view file;  ///< Of the shared object, up to its version.
  const char* package;    ///< That brings it along, of whatever version.
  const char* needed_for;
};

constexpr std::array<Library, 8> kLibraries{{
    {"MuJoCo", "libmujoco.so", "libmujoco-dev", "run, plan --fly"},
    {"Ipopt", "libipopt.so", "coinor-libipopt-dev", "plan --solver ipopt"},
    {"PCL", "libpcl_common.so", "libpcl-dev", "seeing terrain"},
    {"OctoMap", "liboctomap.so", "liboctomap-dev", "seeing terrain"},
    {"OpenCV", "libopencv_core.so", "libopencv-core-dev", "seeing terrain, pictures"},
    {"LCM", "liblcm.so", "liblcm-dev", "logs and live channels"},
    {"yaml-cpp", "libyaml-cpp.so", "libyaml-cpp-dev", "configuration"},
    {"SQLite", "libsqlite3.so", "libsqlite3-dev", "campaign"},
}};

/// Real paths of the shared objects in this process, by their file names.
std::map<std::string, fs::path> loaded_objects() {
  std::map<std::string, fs::path> objects;
  const auto note = [](dl_phdr_info* info, std::size_t /*size*/, void* found) {
    std::error_code error;
    const fs::path name = info->dlpi_name;
    const fs::path file = fs::canonical(name, error);
    if (!error) (*static_cast<std::map<std::string, fs::path>*>(found))[name.filename()] = file;
    return 0;
  };
  dl_iterate_phdr(note, &objects);
  return objects;
}

/// "libmujoco2.2.2 2.2.2-3"; empty where dpkg does not know the file or is not there.
std::string debian_package(const fs::path& file) {
  constexpr double kPatience = 10.0;  // [s]
  const auto owner = campaign::call({"dpkg-query", "--search", file.string()}, kPatience);
  const std::string name = owner.output.substr(0, owner.output.rfind(": "));
  if (owner.status != 0 || name.empty()) return "";
  const auto package = campaign::call(
      {"dpkg-query", "--show", "--showformat", "${Package} ${Version}", name}, kPatience);
  return package.status == 0 ? package.output : "";
}

Finding check_library(const Library& library, const std::map<std::string, fs::path>& objects) {
  Finding finding{.name = library.name, .needed_for = library.needed_for};
  const auto object = objects.lower_bound(std::string(library.file));
  if (object == objects.end() || !object->first.starts_with(library.file)) {
    finding.found = "not loaded";
    finding.fix = std::string("apt-get install ") + library.package + " and build again";
    return finding;
  }
  finding.ok = true;
  const std::string package = debian_package(object->second);
  const std::string file = object->second.filename();
  finding.found = package.empty() ? file : package + " (" + file + ")";
  return finding;
}

Finding compiled_in(const char* name, const std::string& version, const char* needed_for) {
  return {.name = name, .ok = true, .found = version + ", compiled in", .needed_for = needed_for};
}

std::string eigen_version() {
  return std::to_string(EIGEN_WORLD_VERSION) + "." + std::to_string(EIGEN_MAJOR_VERSION) + "." +
         std::to_string(EIGEN_MINOR_VERSION);
}

}  // namespace

std::vector<Finding> check_packages() {
  const std::map<std::string, fs::path> objects = loaded_objects();
  std::vector<Finding> findings;
  findings.reserve(std::size(kLibraries) + 2);
  for (const Library& library : kLibraries) findings.push_back(check_library(library, objects));
  findings.push_back(compiled_in("Ceres", HOPSCOTCH_CERES_VERSION, "calibrate"));
  findings.push_back(compiled_in("Eigen", eigen_version(), "everything"));
  return findings;
}

}  // namespace hopscotch::apps
