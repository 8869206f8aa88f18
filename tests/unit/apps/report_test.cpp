#include "apps/report.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include "apps/report_data.hpp"
#include "apps/text_file.hpp"
#include "tests/unit/apps/fake_run.hpp"

namespace hopscotch::apps {
namespace {

class Report : public testing::Test {
 protected:
  Report() {
    const auto* test = testing::UnitTest::GetInstance()->current_test_info();
    folder_.path =
        std::filesystem::path(testing::TempDir()) / (std::string("report_") + test->name());
    std::filesystem::remove_all(folder_.path);
    fake::write_run(folder_);
  }
  ~Report() override { std::filesystem::remove_all(folder_.path); }

  std::string page() const {
    write_report(folder_.path);
    return read_file(folder_.report());
  }
  void write_picture(const std::string& name) const {
    std::filesystem::create_directories(folder_.frames());
    const cv::Mat picture(270, 480, CV_8UC3, cv::Scalar(200, 120, 40));
    ASSERT_TRUE(cv::imwrite((folder_.frames() / name).string(), picture));
  }

  RunFolder folder_;
};

/// What is wrong with the nesting of the tags; empty if all is well.
std::string nesting_error(const std::string& html) {
  const std::set<std::string> single{"meta", "link", "br", "img", "input", "!DOCTYPE"};
  std::vector<std::string> open;
  for (std::size_t at = html.find('<'); at != std::string::npos; at = html.find('<', at)) {
    const std::size_t end = html.find('>', at);
    if (end == std::string::npos) return "tag without end";
    const std::string tag = html.substr(at + 1, end - at - 1);
    at = end;
    const bool closing = tag.front() == '/';
    const std::size_t begin = closing ? 1 : 0;
    const std::string name = tag.substr(begin, tag.find_first_of(" \n/", begin) - begin);
    if (single.contains(name) || tag.back() == '/') continue;
    if (!closing) {
      open.push_back(name);
      if (name == "style" || name == "script") at = html.find("</" + name, at);
    } else if (open.empty() || open.back() != name) {
      return "</" + name + "> closes " + (open.empty() ? "nothing" : open.back());
    } else {
      open.pop_back();
    }
  }
  return open.empty() ? "" : open.back() + " is never closed";
}

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t n = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++n;
  return n;
}

TEST(NestingCheck, SeesWrongNesting) {
  EXPECT_EQ(nesting_error("<p>a<br>b</p>"), "");
  EXPECT_NE(nesting_error("<p><b>a</p></b>"), "");
  EXPECT_NE(nesting_error("<p>"), "");
}

TEST_F(Report, TagsAreBalanced) {
  EXPECT_EQ(nesting_error(page()), "");
}

TEST_F(Report, NoNumberIsMissingItsValue) {
  std::string text = page();
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  const auto is_letter = [](char c) { return std::isalpha(static_cast<unsigned char>(c)) != 0; };
  for (std::size_t at = text.find("nan"); at != std::string::npos; at = text.find("nan", at + 1)) {
    const bool in_word = is_letter(text[at - 1]) || is_letter(text[at + 3]);
    EXPECT_TRUE(in_word) << text.substr(at - 30, 60);
  }
  EXPECT_FALSE(contains(text, "=\"inf"));
  // A dash stands for a missing number in tables; in a drawing it would be an error.
  EXPECT_FALSE(contains(text, "=\"–"));
  EXPECT_FALSE(contains(text, "m–"));
}

TEST_F(Report, LoadsNothingFromOutside) {
  const std::string text = page();
  for (const char* way : {"http-equiv", "@import", "url(", "<iframe", "fetch(", "src=\"http",
                          "href=\"http", "<script src"}) {
    EXPECT_FALSE(contains(text, way)) << way;
  }
}

TEST_F(Report, StaysSmall) {
  EXPECT_LT(page().size(), 2'000'000U);
}

TEST_F(Report, SaysTheResultInOneSentenceAndEscapesNames) {
  EXPECT_TRUE(
      contains(page(), "<h1>HECTOR crossed “gap &amp; &lt;step&gt;” with 2 jumps in 3.7 s.</h1>"));
}

TEST_F(Report, ShowsEveryJumpChoiceAndLimit) {
  const std::string text = page();
  EXPECT_TRUE(contains(text, "<b>Jump 1</b>"));
  EXPECT_TRUE(contains(text, "<b>Jump 2</b>"));
  EXPECT_TRUE(contains(text, "1 × tread_too_short"));
  EXPECT_TRUE(contains(text, "Knee torque over speed"));
  EXPECT_TRUE(contains(text, "Vertical ground force"));
  EXPECT_TRUE(contains(text, "n = 740"));  // MPC solves: every fifth of 3700 ticks
}

TEST_F(Report, EqualRunsGiveEqualPages) {
  const std::string first = page();
  EXPECT_EQ(page(), first);
}

TEST_F(Report, EmbedsTheKeyFramesThatAreThere) {
  EXPECT_EQ(count(page(), "<img "), 0U);
  write_picture("crossing.png");
  write_picture("01-1-crouch.png");
  write_picture("01-2-lift-off.png");
  const std::string text = page();
  EXPECT_EQ(count(text, "src=\"data:image/jpeg;base64,"), 3U);
  EXPECT_EQ(nesting_error(text), "");
}

TEST_F(Report, LinksOnlyToFilesThatAreThere) {
  EXPECT_FALSE(contains(page(), "video.mp4"));
  write_file_atomically(folder_.video(), "film");
  EXPECT_TRUE(contains(page(), "href=\"video.mp4\""));
}

TEST_F(Report, RunWithoutAnyJumpStillHasAPage) {
  RunResult result = fake::result();
  result.outcome = RunOutcome::refused;
  result.reason = "gap_too_wide: the gap of 0.90 m is wider than 0.55 m";
  result.jumps.clear();
  write_run_result(folder_.result(), result);
  msgs::RunLogWriter log(folder_.log(), 1);
  core::TargetChoice choice;
  choice.refusal = {core::Reason::gap_too_wide, "the gap of 0.90 m is wider than 0.55 m"};
  log.write({}, choice);
  log.close();
  const std::string text = page();
  EXPECT_EQ(nesting_error(text), "");
  EXPECT_TRUE(contains(text, "refused gap_too_wide") || contains(text, "refused — gap_too_wide"));
}

TEST_F(Report, MissingFilesAreNamed) {
  std::filesystem::remove(folder_.log());
  try {
    write_report(folder_.path);
    FAIL() << "accepted";
  } catch (const std::runtime_error& error) {
    EXPECT_TRUE(contains(error.what(), "run.lcm")) << error.what();
  }
}

TEST_F(Report, RecordFindsTheInstantsOfEachJump) {
  const RunRecord run = load_run(folder_);
  ASSERT_EQ(run.jumps.size(), 2U);
  constexpr double kTick = 1.5e-3;   // phases change on whole ticks
  constexpr double kExtreme = 5e-3;  // pitching shifts the CoM's extremes a little
  const double start = fake::kJump + 2.0 * fake::kStand;
  const JumpRecord& second = run.jumps[1];
  EXPECT_NEAR(second.begin, start, kTick);
  EXPECT_NEAR(second.at(Instant::crouch), start + 0.5 * fake::kTakeoff, kExtreme);
  EXPECT_NEAR(second.at(Instant::liftoff), start + fake::kTakeoff, kTick);
  EXPECT_NEAR(second.at(Instant::apex), start + fake::kTakeoff + 0.5 * fake::kFlight, kExtreme);
  EXPECT_NEAR(second.at(Instant::touchdown), start + fake::kTakeoff + fake::kFlight, kTick);
  EXPECT_NEAR(second.at(Instant::rest), start + fake::kJump, kTick);
  ASSERT_NE(run.plan_of(second), nullptr);
  EXPECT_EQ(run.plan_of(second)->id, 2U);
}

TEST_F(Report, RecordPutsThePlanBesideWhatWasMeasured) {
  const RunRecord run = load_run(folder_);
  const Moment& pushing = run.moment_at(fake::kStand + 0.2);
  // The plan holds its force from knot to knot, 10 ms apart: up to 2.5 % of the rise of one weight.
  EXPECT_NEAR(pushing.planned_normal_force, pushing.normal_force, 0.03 * fake::kWeight);
  EXPECT_TRUE(std::isnan(run.moment_at(0.1).planned_normal_force)) << "nothing is planned at rest";
}

TEST_F(Report, RunsOnAStateLogWithoutTruth) {
  msgs::RunLogWriter log(folder_.log(), 1);
  for (int tick = 0; tick < 50; ++tick) {
    const core::Stamp now{tick * 1'000'000};
    log.write(now, fake::truth_at(now.seconds(), 0.0, -1.0).state);
  }
  log.close();
  EXPECT_EQ(load_run(folder_).moments.size(), 50U);
  EXPECT_EQ(nesting_error(page()), "");
}

}  // namespace
}  // namespace hopscotch::apps
