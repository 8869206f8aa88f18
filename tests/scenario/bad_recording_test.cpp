// Recordings that are damaged, in another unit or do not fit together: an error that names the
// file, or a degraded status, and never a target.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <random>
#include <sstream>
#include <string>

#include "tests/folder_test.hpp"
#include "tests/scenario/program.hpp"

namespace hopscotch {
namespace {

namespace fs = std::filesystem;

using apps::Answer;
using apps::call;

constexpr int kWidth = 320;
constexpr int kHeight = 240;

/// Of a level floor 0.6 m below a camera that looks down by 0.5 rad; 0 where it is too far [m].
double floor_depth(int v) {
  const double down = std::sin(0.5) + (v - 120) / 192.5 * std::cos(0.5);
  return down > 0.25 ? 0.6 / down : 0.0;
}

using Pixel = std::function<double(int u, int v)>;

/// A 16-bit PGM.
/// @param unit Of its numbers [m].
std::string image_of(double unit, const Pixel& depth) {
  std::string bytes = "P5\n320 240\n65535\n";
  for (int v = 0; v < kHeight; ++v) {
    for (int u = 0; u < kWidth; ++u) {
      const int value = static_cast<int>(std::lround(depth(u, v) / unit));
      bytes += static_cast<char>(value >> 8);
      bytes += static_cast<char>(value & 0xFF);
    }
  }
  return bytes;
}

std::string floor_image(double unit) {
  return image_of(unit, [](int, int v) { return floor_depth(v); });
}

/// The points of the same floor, z up.
/// @param unit Of its numbers [m].
std::string floor_points(double unit, int& count) {
  std::ostringstream text;
  count = 0;
  for (double x = 0.2; x < 1.6; x += 0.02) {
    for (double y = -0.5; y < 0.5; y += 0.02) {
      text << x / unit << " " << y / unit << " " << 0.01 / unit << "\n";
      ++count;
    }
  }
  return text.str();
}

std::string floor_pcd(double unit) {
  int count = 0;
  const std::string points = floor_points(unit, count);
  const std::string n = std::to_string(count);
  return "VERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH " + n +
         "\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS " + n + "\nDATA ascii\n" + points;
}

std::string floor_ply(double unit) {
  int count = 0;
  const std::string points = floor_points(unit, count);
  return "ply\nformat ascii 1.0\nelement vertex " + std::to_string(count) +
         "\nproperty float x\nproperty float y\nproperty float z\nend_header\n" + points;
}

class BadRecording : public FolderTest {
 protected:
  std::string write(const std::string& name, const std::string& bytes) const {
    std::ofstream(folder_ / name, std::ios::binary) << bytes;
    return (folder_ / name).string();
  }
  static std::string bytes_of(const fs::path& file) {
    std::ostringstream text;
    text << std::ifstream(file, std::ios::binary).rdbuf();
    return text.str();
  }
  /// Status 2 and a message that names the file.
  static void expect_refused(const std::string& arguments, const std::string& file,
                             const std::string& says) {
    const Answer answer = call(arguments);
    EXPECT_EQ(answer.status, 2) << arguments << "\n" << answer.output;
    EXPECT_NE(answer.output.find(says), std::string::npos) << arguments << "\n" << answer.output;
    EXPECT_NE(answer.output.find(file), std::string::npos) << arguments << "\n" << answer.output;
  }
};

TEST_F(BadRecording, ImagesOfTheWrongFormatOrCutShortAreRefused) {
  const std::string good = write("floor.pgm", floor_image(0.001));
  expect_refused("scene " + write("a.pgm", "P5\n320 240\n255\n" + std::string(320 * 240, '\x40')),
                 "a.pgm", "8 bits");
  expect_refused("scene " + write("b.pgm", "P5\n320 x"), "b.pgm", "damaged");
  const std::string pictures = (folder_ / "pictures").string();
  ASSERT_EQ(call("scene " + good + " --out " + pictures).status, 0);
  const std::string png = bytes_of(folder_ / "pictures" / "depth.png");
  expect_refused("scene " + write("c.png", png), "c.png", "16-bit");
  expect_refused("scene " + write("d.png", png.substr(0, png.size() / 2)), "d.png", "cut short");
  expect_refused("scene " + write("e.tiff", std::string("II*\0", 4) + "no more"), "e.tiff",
                 "cannot be decoded");
}

TEST_F(BadRecording, ImagesInAnotherUnitAreRefusedOrGiveNoTarget) {
  EXPECT_NE(call("scene " + write("mm.pgm", floor_image(0.001))).output.find("target: "),
            std::string::npos);
  expect_refused("scene " + write("cm.pgm", floor_image(0.01)), "cm.pgm", "unit");
  expect_refused("scene " + write("tenth.pgm", floor_image(0.0001)), "tenth.pgm",
                 "only 0 points hold a usable reading");
  expect_refused("scene " + write("m.pgm", floor_image(0.001)) + " --depth-scale 1", "m.pgm",
                 "unit");
  // A fifth of a millimetre, as some data sets have it: the floor would be 3 m below the camera.
  const std::string fifth = write("fifth.pgm", floor_image(0.0002));
  const Answer answer = call("scene " + fifth + " --json 2>/dev/null");
  EXPECT_NE(answer.output.find("\"status\":\"degraded: the camera would be 3.0 m above"),
            std::string::npos)
      << answer.output;
  EXPECT_NE(answer.output.find("\"targets\":[]"), std::string::npos) << answer.output;
  EXPECT_NE(call("scene " + fifth + " --depth-scale 0.0002").output.find("target: "),
            std::string::npos);
}

TEST_F(BadRecording, CloudsInAnotherUnitAreRefused) {
  EXPECT_NE(
      call("scene " + write("m.pcd", floor_pcd(1.0)) + " --up z --forward x").output.find("target"),
      std::string::npos);
  for (const double unit : {0.001, 0.01, 1000.0}) {
    expect_refused("scene " + write("c.pcd", floor_pcd(unit)) + " --up z --forward x", "c.pcd",
                   "read in metres");
    expect_refused("scene " + write("c.ply", floor_ply(unit)) + " --up z --forward x", "c.ply",
                   "read in metres");
  }
}

TEST_F(BadRecording, CloudsOfNoPointsAreRefused) {
  std::string nothing = floor_pcd(1.0);
  const std::size_t data = nothing.find("DATA ascii\n") + 11;
  std::istringstream lines(nothing.substr(data));
  nothing.resize(data);
  for (std::string line; std::getline(lines, line);) nothing += "nan nan nan\n";
  expect_refused("scene " + write("nan.pcd", nothing), "nan.pcd", "only 0 points");
}

TEST_F(BadRecording, AnImageWithNearlyHalfOfItsPixelsLostIsDegraded) {
  std::mt19937 random(4);
  std::bernoulli_distribution lost(0.45);
  const std::string image =
      image_of(0.001, [&](int, int v) { return lost(random) ? 0.0 : floor_depth(v); });
  const Answer answer = call("scene " + write("lossy.pgm", image) + " --json 2>/dev/null");
  EXPECT_NE(answer.output.find("of the ground ahead carries no reading"), std::string::npos)
      << answer.output;
}

TEST_F(BadRecording, AFolderOfImagesIsReplayedInTheOrderOfItsNumbers) {
  std::string poses;
  for (int i = 1; i <= 11; ++i) {
    write("depth_" + std::to_string(i) + ".pgm", floor_image(0.001));
    poses += std::to_string(0.1 * i) + " 0 0 0 0 0 0 1\n";
  }
  write("poses.txt", poses);
  const Answer answer = call("replay " + folder_.string() + " --json 2>/dev/null");
  EXPECT_EQ(answer.status, 0) << answer.output;
  EXPECT_EQ(answer.output.find("stale"), std::string::npos) << answer.output;
}

TEST_F(BadRecording, AFolderOfImagesIsRefusedWithTheReason) {
  const std::string image = floor_image(0.001);
  write("depth_1.pgm", image);
  write("depth_2.pgm", image);
  const std::string line = " 0 0 0 0 0 0 1\n";
  const struct {
    std::string poses;
    const char* says;
  } kCases[] = {{"0.2" + line + "0.1" + line, "time goes backwards"},
                {"0.1" + line, "no pose for depth_2.pgm"},
                {"0.1" + line + "0.2 12 0 0 0 0 0 1\n", "read in metres"},
                {"0.1" + line + "1e300" + line, "stamp"},
                {"0.1" + line + "0.2 nan 0 0 0 0 0 1\n", "poses.txt:2"},
                {"0.1" + line + "0.2 0 0 0 1 1 1 1\n", "quaternion"}};
  for (const auto& tested : kCases) {
    write("poses.txt", tested.poses);
    expect_refused("replay " + folder_.string(), "poses.txt", tested.says);
  }
  write("poses.txt", "0.1" + line + "0.2" + line);
  EXPECT_EQ(call("replay " + folder_.string()).status, 0);
  write("depth_2.pgm", image.substr(0, image.size() / 2));
  expect_refused("replay " + folder_.string(), "depth_2.pgm", "cut short");
  write("depth_2.pgm", "P5\n320 240\n65535\n" + std::string(2 * 320 * 240, '\0'));
  expect_refused("replay " + folder_.string(), "depth_2.pgm", "no pixel holds a reading");
  write("depth_2.pgm", image);
  expect_refused("replay " + folder_.string() + " --intrinsics 385,385,640,360", "320x240",
                 "do not fit");
}

}  // namespace
}  // namespace hopscotch
