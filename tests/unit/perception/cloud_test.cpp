#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <limits>
#include <random>
#include <string>

#include "core/config_reader.hpp"
#include "perception/cloud_file.hpp"
#include "perception/cloud_map.hpp"
#include "perception/ground_frame.hpp"
#include "perception/line_survey.hpp"
#include "perception/plane_segmentation.hpp"
#include "tests/folder_test.hpp"
#include "tests/unit/perception/synthetic_terrain.hpp"

/// Single recordings: files, planes, ground frame, map.
namespace hopscotch::perception {
namespace {

namespace fs = std::filesystem;

class CloudFile : public FolderTest {
 protected:
  fs::path write(const std::string& name, const std::string& content) const {
    std::ofstream(folder_ / name, std::ios::binary) << content;
    return folder_ / name;
  }
  static std::string pcd_header(int width, int height, const std::string& data) {
    return "# .PCD v0.7\nVERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH " +
           std::to_string(width) + "\nHEIGHT " + std::to_string(height) +
           "\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS " + std::to_string(width * height) + "\nDATA " +
           data + "\n";
  }
  static std::string binary(const std::vector<float>& numbers) {
    return {reinterpret_cast<const char*>(numbers.data()), numbers.size() * sizeof(float)};
  }
  static std::string message_of(const fs::path& file) {
    try {
      (void)read_cloud_file(file);
    } catch (const core::ConfigError& error) {
      return error.what();
    }
    return "";
  }
};

TEST_F(CloudFile, ReadsAsciiAndBinaryPcdAndPly) {
  const fs::path ascii = write("a.pcd", pcd_header(2, 1, "ascii") + "1 2 3\nnan nan nan\n");
  const fs::path plain =
      write("b.pcd", pcd_header(2, 2, "binary") + binary({1, 2, 3, 4, 5, 6, 0, 0, 0, 7, 8, 9}));
  const fs::path ply = write("c.ply",
                             "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\n"
                             "property float y\nproperty float z\nend_header\n1 2 3\n4 5 6\n");
  const PointCloud from_ascii = read_cloud_file(ascii);
  ASSERT_EQ(from_ascii.points.size(), 2U);
  EXPECT_EQ(from_ascii.points[0], Eigen::Vector3f(1, 2, 3));
  EXPECT_FALSE(from_ascii.points[1].allFinite());
  const PointCloud from_binary = read_cloud_file(plain);
  EXPECT_TRUE(from_binary.is_organised());
  EXPECT_EQ(from_binary.points[3], Eigen::Vector3f(7, 8, 9));
  EXPECT_FALSE(from_binary.points[2].allFinite()) << "the origin stands for no measurement";
  EXPECT_EQ(read_cloud_file(ply).points[1], Eigen::Vector3f(4, 5, 6));
}

TEST_F(CloudFile, ReadsCompressedPcdColumnByColumn) {
  // Two points: all x, then all y, then all z. The packed data: 12 literals, then a reference back
  // by 12 bytes over 8, then 4 literals.
  const std::string columns = binary({1, 2, 3, 1, 2, 7});
  const std::string packed = std::string(1, '\x0B') + columns.substr(0, 12) + "\xC0\x0B" +
                             std::string(1, '\x03') + columns.substr(20);
  const auto size = [](std::uint32_t bytes) {
    return std::string(reinterpret_cast<const char*>(&bytes), sizeof bytes);
  };
  const std::string header = pcd_header(2, 1, "binary_compressed");
  const fs::path file = write("c.pcd", header + size(20) + size(24) + packed);
  const PointCloud cloud = read_cloud_file(file);
  EXPECT_EQ(cloud.points[0], Eigen::Vector3f(1, 3, 2));
  EXPECT_EQ(cloud.points[1], Eigen::Vector3f(2, 1, 7));
  const fs::path damaged = write("d.pcd", header + size(19) + size(24) + std::string(19, '\xC0'));
  EXPECT_NE(message_of(damaged).find("damaged"), std::string::npos) << message_of(damaged);
}

TEST_F(CloudFile, ReadsBigEndianPlyBehindAnotherElement) {
  const std::string header =
      "ply\nformat binary_big_endian 1.0\nelement camera 1\nproperty uchar id\n"
      "element vertex 1\nproperty double x\nproperty double y\nproperty double z\nend_header\n";
  const std::string one("\x3F\xF0\0\0\0\0\0\0", 8);
  const fs::path file = write("b.ply", header + "7" + one + one + one);
  EXPECT_EQ(read_cloud_file(file).points[0], Eigen::Vector3f(1, 1, 1));
}

TEST_F(CloudFile, NamesTheFileAndWhatIsWrongWithIt) {
  EXPECT_NE(message_of(folder_ / "none.pcd").find("no such file"), std::string::npos);
  const std::string whole = pcd_header(2, 2, "binary") + binary(std::vector<float>(12, 1.0F));
  const fs::path cut = write("cut.pcd", whole.substr(0, whole.size() - 5));
  EXPECT_NE(message_of(cut).find("cut short"), std::string::npos) << message_of(cut);
  EXPECT_NE(message_of(cut).find("cut.pcd"), std::string::npos);
  const fs::path huge = write("huge.pcd", pcd_header(30000, 30000, "binary"));
  EXPECT_NE(message_of(huge).find("at most"), std::string::npos) << message_of(huge);
  EXPECT_NE(message_of(write("text.pcd", "hello")), "");
  EXPECT_NE(message_of(write("lzf.pcd", pcd_header(2, 2, "binary_compressed") + "123456789")), "");
  EXPECT_NE(message_of(write("short.ply", "ply\nformat ascii 1.0\nelement vertex 9\n")), "");
  std::string other = whole;
  other.replace(other.find("FIELDS x y z"), 12, "FIELDS a b c");
  EXPECT_NE(message_of(write("other.pcd", other)).find("x, y, z"), std::string::npos);
}

TEST_F(CloudFile, SurvivesRandomDamage) {
  const std::string whole = pcd_header(8, 4, "binary") + binary(std::vector<float>(96, 1.0F));
  std::mt19937 random(3);
  for (int i = 0; i < 2000; ++i) {
    std::string damaged = whole;
    for (int hit = 0; hit < 4; ++hit) {
      damaged[random() % damaged.size()] = static_cast<char>(random() & 0xFFU);
    }
    (void)message_of(write("d.pcd", damaged));  // an error or a cloud, but no crash
  }
}

/// A floor, a step of 10 cm 0.8 m ahead, seen by a camera 0.6 m above the floor: frame C.
PointCloud step_in_view(double pitch) {
  PointCloud cloud{.width = 320, .height = 240, .points = {}};
  const Eigen::Matrix3d R_WC = (Eigen::Matrix3d() << 0, -std::sin(pitch), std::cos(pitch), -1, 0, 0,
                                0, -std::cos(pitch), -std::sin(pitch))
                                   .finished();
  std::mt19937 random(5);
  std::normal_distribution<double> noise(0.0, 0.0015);
  for (int v = 0; v < cloud.height; ++v) {
    for (int u = 0; u < cloud.width; ++u) {
      const Eigen::Vector3d ray = R_WC * Eigen::Vector3d((u - 160) / 190.0, (v - 120) / 190.0, 1.0);
      double depth = ray.z() < 0.0 ? -0.6 / ray.z() : 99.0;
      const double riser = 0.8 / ray.x();
      const double at_riser = 0.6 + riser * ray.z();
      if (riser > 0.0 && riser < depth && at_riser < 0.1) depth = riser;
      const double top = ray.z() < 0.0 ? -0.5 / ray.z() : 99.0;
      if (top < depth && top * ray.x() > 0.8) depth = top;
      const double z = depth < 3.0 ? depth + noise(random) : core::kNaN;
      cloud.points.emplace_back(
          (z * Eigen::Vector3d((u - 160) / 190.0, (v - 120) / 190.0, 1.0)).cast<float>());
    }
  }
  return cloud;
}

TEST(SceneGround, FloorGivesUpHeightAndTheStepIsFound) {
  const PerceptionConfig config = test::perception_config();
  const PointCloud cloud = step_in_view(0.5);
  const std::vector<PlanePatch> planes = segment_planes(config.planes, cloud);
  ASSERT_GE(planes.size(), 2U);
  const auto frame = find_ground_frame(planes, {.optical_frame = true});
  ASSERT_TRUE(frame) << frame.error().sentence;
  EXPECT_NEAR(frame->X_WR.translation().z(), 0.6, 0.004);
  EXPECT_NEAR(std::asin(-frame->X_WR.linear()(2, 2)), 0.5, 0.01) << "pitch of the camera";

  std::vector<Eigen::Vector3f> points;
  for (const Eigen::Vector3f& p : cloud.points) points.push_back(frame->X_WR.cast<float>() * p);
  const core::TerrainMap map =
      map_cloud(config, {.points = points, .p_WC = frame->X_WR.translation()},
                {.from_x = -0.3, .to_x = 2.0, .half_width = 0.5});
  const StancePose stance{.p_WS = Eigen::Vector3d::Zero(),
                          .heading = 0.0,
                          .half_stance = 0.098,
                          .track_half_width = 0.04};
  const LineSurvey survey = survey_line(config.one_step, map, stance, 1.5);
  ASSERT_EQ(survey.features.edge_count, 1U);
  EXPECT_EQ(survey.features.edges[0].kind, core::EdgeKind::up);
  EXPECT_NEAR(survey.features.edges[0].x, 0.8, 0.01);
  EXPECT_NEAR(survey.features.edges[0].step, 0.1, 0.004);
}

TEST(SceneGround, StatedPoseIsTaken) {
  const std::vector<PlanePatch> planes =
      segment_planes(test::perception_config().planes, step_in_view(0.5));
  const auto frame = find_ground_frame(
      planes,
      {.camera_height = 0.62, .camera_pitch = 0.5, .optical_frame = true, .origin = {0.1, -0.2}});
  ASSERT_TRUE(frame);
  EXPECT_NEAR((frame->X_WR.translation() - Eigen::Vector3d(-0.1, 0.2, 0.62)).norm(), 0.0, 1e-12);
  EXPECT_NEAR(frame->floor_height, 0.02, 0.005);
}

TEST(SceneGround, WithoutFloorAndPoseThereIsNoFrame) {
  EXPECT_FALSE(find_ground_frame({}, {.optical_frame = true}));
  EXPECT_TRUE(find_ground_frame({}, {.up = Eigen::Vector3d::UnitZ()}));
}

}  // namespace
}  // namespace hopscotch::perception
