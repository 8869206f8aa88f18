#include "perception/cloud_file.hpp"

#include <fstream>
#include <limits>
#include <string>

#include "core/config_reader.hpp"
#include "perception/pcd_format.hpp"
#include "perception/ply_format.hpp"

namespace hopscotch::perception {

namespace {

namespace fs = std::filesystem;

constexpr std::uintmax_t kBytesMax = 1U << 30U;

[[noreturn]] void reject(const fs::path& file, const std::string& why) {
  throw core::ConfigError(file.string() + ": " + why);
}

std::string bytes_of(const fs::path& file) {
  if (!fs::is_regular_file(file)) reject(file, "is no file");
  const std::uintmax_t size = fs::file_size(file);
  if (size > kBytesMax) reject(file, "is larger than 1 GiB");
  std::string bytes(static_cast<std::size_t>(size), '\0');
  std::ifstream stream(file, std::ios::binary);
  stream.read(bytes.data(), static_cast<std::streamsize>(size));
  if (stream.gcount() != static_cast<std::streamsize>(size)) reject(file, "cannot be read");
  return bytes;
}

}  // namespace

PointCloud read_cloud_file(const fs::path& file) {
  const std::string bytes = bytes_of(file);
  PointCloud cloud;
  try {
    const bool ply = bytes.starts_with("ply\n") || bytes.starts_with("ply\r");
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
