#include "apps/key_frames.hpp"

#include <gtest/gtest.h>

#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <string>

#include "apps/text_file.hpp"
#include "apps/video.hpp"
#include "sim/scene_builder.hpp"
#include "sim/scene_renderer.hpp"
#include "tests/unit/apps/fake_run.hpp"

namespace hopscotch::apps {
namespace {

class Pictures : public testing::Test {
 protected:
  Pictures() {
    const auto* test = testing::UnitTest::GetInstance()->current_test_info();
    folder_.path =
        std::filesystem::path(testing::TempDir()) / (std::string("pictures_") + test->name());
    std::filesystem::remove_all(folder_.path);
    fake::write_run(folder_);
    sim::Terrain terrain;
    terrain.slabs.push_back({.centre = {0.4, 0.0}, .half_size = {1.5, 0.6}});
    write_file_atomically(folder_.scene(),
                          sim::scene_mjcf(model::RobotParameters::load(folder_.robot()), terrain));
  }
  ~Pictures() override { std::filesystem::remove_all(folder_.path); }

  /// A log that is over soon, since drawing takes its time.
  void write_short_log() const {
    msgs::RunLogWriter log(folder_.log(), 1);
    for (int tick = 0; tick < 150; ++tick) {
      const double time = 1e-3 * tick;
      log.write(core::Stamp::from_seconds(time), fake::truth_at(time, 0.0, -1.0));
    }
    log.close();
  }

  RunFolder folder_;
};

TEST_F(Pictures, EveryInstantOfEveryJumpAndTheCrossingAreDrawn) {
  if (const auto lack = draw_key_frames(folder_)) GTEST_SKIP() << *lack;
  for (const char* name : {"01-1-crouch", "01-2-lift-off", "01-3-apex", "01-4-touchdown",
                           "01-5-rest", "02-1-crouch", "02-5-rest", "crossing"}) {
    const std::string file = (folder_.frames() / name).string() + ".png";
    const cv::Mat picture = cv::imread(file);
    ASSERT_FALSE(picture.empty()) << file;
    cv::Scalar mean;
    cv::Scalar deviation;
    cv::meanStdDev(picture, mean, deviation);
    EXPECT_GT(deviation[0], 5.0) << file << " shows nothing";
  }
}

TEST_F(Pictures, RunWithoutMotionGivesNone) {
  msgs::RunLogWriter(folder_.log(), 1).close();
  EXPECT_EQ(draw_key_frames(folder_), std::nullopt);
  EXPECT_FALSE(std::filesystem::exists(folder_.frames() / kCrossingPicture));
}

TEST_F(Pictures, VideoIsAnMp4OfTheWholeRun) {
  write_short_log();
  try {
    write_video(folder_);
  } catch (const sim::RendererUnavailable& lack) {
    GTEST_SKIP() << lack.what();
  }
  const std::string film = read_file(folder_.video());
  EXPECT_EQ(film.substr(4, 4), "ftyp");
  // +faststart puts the index before the pictures, so that a browser can begin at once.
  EXPECT_LT(film.find("moov"), film.find("mdat"));
  EXPECT_FALSE(std::filesystem::exists(folder_.video().string() + ".part"));
}

TEST_F(Pictures, VideoWithoutItsSceneIsRefusedByName) {
  write_short_log();
  std::filesystem::remove(folder_.scene());
  try {
    write_video(folder_);
    FAIL() << "accepted";
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("scene.xml"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace hopscotch::apps
