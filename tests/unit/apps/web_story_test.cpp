#include "apps/web_story.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "apps/web_json.hpp"
#include "apps/web_run.hpp"
#include "msgs/run_log.hpp"
#include "tests/unit/apps/fake_run.hpp"

namespace hopscotch::apps {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

model::RobotParameters hector() {
  return model::RobotParameters::load(fs::path(HOPSCOTCH_SOURCE_DIR) / "config/robots/hector.yaml");
}

class WebStoryOfARun : public ::testing::Test {
 protected:
  WebStoryOfARun()
      : file_(fs::path(testing::TempDir()) /
              (std::string("web_story-") +
               testing::UnitTest::GetInstance()->current_test_info()->name() + ".lcm")) {
    fake::write_log(file_);
    msgs::read_run_log(file_, story_.handlers());
  }
  ~WebStoryOfARun() override { fs::remove(file_); }

  fs::path file_;
  WebStory story_{hector(), {.run_id = "ab", .scenario = "a \"name\"", .live = true, .result = {}}};
};

TEST_F(WebStoryOfARun, NamesEveryNumberOfAFrame) {
  const json about = json::parse(story_.about());
  EXPECT_EQ(about["scenario"], "a \"name\"");
  EXPECT_EQ(about["scene"]["slabs"].size(), 2U);
  const json news = json::parse(story_.since(0, 0));
  ASSERT_GT(news["frames"].size(), 100U);
  for (const json& frame : news["frames"]) ASSERT_EQ(frame.size(), about["columns"].size());
  // One frame per sixtieth of a second of a run of 3.7 s.
  EXPECT_NEAR(news["total"].get<double>(), 60.0 * fake::result().duration, 15.0);
}

TEST_F(WebStoryOfARun, HappeningsComeInOrderWithTheirKinds) {
  const json news = json::parse(story_.since(0, 0));
  int plans = 0;
  double before = 0.0;
  for (const json& happening : news["happenings"]) {
    EXPECT_GE(happening["t"].get<double>(), before);
    before = happening["t"];
    if (happening["kind"] == "plan") {
      ++plans;
      EXPECT_EQ(happening["path"].size(), 111U);
      EXPECT_EQ(happening["target"]["soles"].size(), 2U);
    }
    if (happening["kind"] == "choice") {
      EXPECT_EQ(happening["rejected"][0]["why"], "tread_too_short");
      EXPECT_EQ(happening["ranked"].size(), 2U);
    }
  }
  EXPECT_EQ(plans, 2);
}

TEST_F(WebStoryOfARun, TellsOnlyWhatIsNew) {
  const auto total = json::parse(story_.since(0, 0))["total"].get<std::size_t>();
  const json nothing = json::parse(story_.since(total, 1000));
  EXPECT_TRUE(nothing["frames"].empty());
  EXPECT_TRUE(nothing["happenings"].empty());
  EXPECT_EQ(json::parse(story_.since(total - 2, 0))["frames"].size(), 2U);
  EXPECT_TRUE(json::parse(story_.since(~std::size_t{0} - 1, 0))["frames"].empty());
}

TEST_F(WebStoryOfARun, EndsWithItsResult) {
  EXPECT_TRUE(json::parse(story_.since(0, 0))["live"]);
  story_.finish("{\"outcome\": \"completed\"}");
  const json news = json::parse(story_.since(0, 0));
  EXPECT_FALSE(news["live"]);
  EXPECT_EQ(news["result"]["outcome"], "completed");
}

TEST(WebJson, UnknownNumbersAreNull) {
  const json frame = json::parse(frame_json({}, hector()));
  EXPECT_EQ(frame.size(), json::parse(frame_columns_json()).size());
  EXPECT_TRUE(frame[8].is_null());
}

TEST(WebJson, TextThatIsNoUnicodeStaysJson) {
  const json text = json::parse(quoted_json("a\xff\"<b>\n"));
  EXPECT_TRUE(text.is_string());
}

TEST(PageCommand, SaysWhatThePageAsked) {
  EXPECT_EQ(page_command(R"({"mode": "clear-fault"})", 7).mode, core::ModeRequest::clear_fault);
  EXPECT_TRUE(page_command(R"({"clear": true})", 7).clear_target);
  const core::OperatorCommand command =
      page_command(R"({"target": {"distance": 0.3, "lateral": -0.02}})", 7);
  EXPECT_EQ(command.run_id, 7U);
  EXPECT_GT(command.sequence, 0U);
  ASSERT_TRUE(command.target);
  EXPECT_EQ(command.target->distance, 0.3);
  EXPECT_EQ(command.target->lateral, -0.02);
  EXPECT_TRUE(std::isnan(command.target->height));
}

TEST(PageCommand, RefusesWhatIsNone) {
  for (const char* bad : {"", "[]", "{}", "{\"mode\": 3}", "{\"mode\": \"dance\"}",
                          "{\"target\": 1}", "{\"target\": {\"distance\": \"far\"}}"}) {
    EXPECT_THROW(static_cast<void>(page_command(bad, 1)), std::invalid_argument) << bad;
  }
}

}  // namespace
}  // namespace hopscotch::apps
