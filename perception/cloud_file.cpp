#include "perception/cloud_file.hpp"

#include <limits>
#include <string>

#include "core/config_reader.hpp"
#include "core/input_file.hpp"
#include "perception/pcd_format.hpp"
#include "perception/ply_format.hpp"

namespace hopscotch::perception {

namespace {

namespace fs = std::filesystem;

[[noreturn]] void reject(const fs::path& file, const std::string& why) {
  throw core::ConfigError(file.string() + ": " + why);
}

}  // namespace

PointCloud read_cloud_file(const fs::path& file) {
  const std::string bytes = core::read_input_file(file);
  PointCloud cloud;
  try {
    const bool ply = bytes.starts_with("ply\n") || bytes.starts_with("ply\r");
    if (!ply && file.extension() == ".ply") throw MalformedCloud("does not start as a PLY does");
    cloud = ply ? read_ply(bytes) : read_pcd(bytes);
  } catch (const MalformedCloud& defect) {
    reject(file, defect.what());
  }
  constexpr float kNotANumber = std::numeric_limits<float>::quiet_NaN();
  for (Eigen::Vector3f& p : cloud.points) {
    if (!p.allFinite() || p.isZero(0.0F)) p = Eigen::Vector3f::Constant(kNotANumber);
  }
  return cloud;
}

}  // namespace hopscotch::perception
