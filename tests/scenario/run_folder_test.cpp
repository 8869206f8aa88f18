// What a run folder keeps is enough to look at the run again.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "apps/text_file.hpp"
#include "tests/folder_test.hpp"
#include "tests/scenario/program.hpp"

namespace hopscotch::apps {
namespace {

namespace fs = std::filesystem;

class RunFolderKept : public FolderTest {
 protected:
  /// Of one leap into `name`.
  [[nodiscard]] Answer run(const std::string& name, const std::string& robot,
                           const std::string& options) const {
    std::ofstream(folder_ / "scenario.yaml") << "name: kept\n"
                                                "robot: "
                                             << robot
                                             << "\nslabs: [{x_m: [-1.0, 4.0]}]\n"
                                                "goal: {jumps: 1}\n";
    return call("run " + (folder_ / "scenario.yaml").string() +
                " --perception truth --no-pictures --out " + at(name) + options);
  }
  [[nodiscard]] std::string at(const std::string& name) const { return (folder_ / name).string(); }

  /// The shipped tuning but for the estimator's trust in its encoders.
  [[nodiscard]] std::string other_tuning() const {
    std::string text = read_file(fs::path(HOPSCOTCH_SOURCE_DIR) / "config/hopscotch.yaml");
    const std::string key = "encoder_sigma_rad: ";
    text.insert(text.find(key) + key.size(), "4.5e-4  # was ");
    std::ofstream(folder_ / "other.yaml") << text;
    return at("other.yaml");
  }
};

TEST_F(RunFolderKept, IsReplayedWithItsOwnTuning) {
  const Answer made = run("out", "hector", " --config " + other_tuning());
  ASSERT_EQ(made.status, 0) << made.output;
  const Answer whole = call("replay " + at("out"));
  EXPECT_EQ(whole.status, 0) << whole.output;
  EXPECT_NE(whole.output.find("0 of 1 plans"), std::string::npos) << whole.output;
  EXPECT_EQ(call("replay " + at("out/run.lcm")).status, 1) << "the program's tuning is another";
  EXPECT_EQ(call("replay " + at("out/run.lcm") + " --config " + at("out/config.yaml")).status, 0);
  EXPECT_EQ(call("replay " + at("out") + " --config " HOPSCOTCH_SOURCE_DIR "/config/hopscotch.yaml")
                .status,
            1);
}

TEST_F(RunFolderKept, ItsTuningMakesTheSameRunAgain) {
  ASSERT_EQ(run("out", "hector", " --config " + other_tuning()).status, 0);
  const Answer again = run("again", "hector", " --config " + at("out/config.yaml"));
  ASSERT_EQ(again.status, 0) << again.output;
  EXPECT_EQ(read_file(at("again/config.yaml")), read_file(at("out/config.yaml")));
  EXPECT_EQ(read_file(at("again/run.lcm")).size(), read_file(at("out/run.lcm")).size());
}

TEST_F(RunFolderKept, HoldsARobotThatIsBasedOnAnother) {
  const Answer made = run("out", "hector-sim", "");
  ASSERT_EQ(made.status, 0) << made.output;
  EXPECT_TRUE(fs::exists(at("out/report.html")));
  EXPECT_EQ(call("explain " + at("out")).status, 0);
  const Answer again = call("replay " + at("out"));
  EXPECT_EQ(again.status, 0) << again.output;
}

TEST_F(RunFolderKept, IsReplayedWithTheRobotOfItsController) {
  const Answer made = run("out", "hector-sim\nplant: {robot: hector-d14}", "");
  ASSERT_EQ(made.status, 0) << made.output;
  const Answer again = call("replay " + at("out"));
  EXPECT_EQ(again.status, 0) << again.output;
}

}  // namespace
}  // namespace hopscotch::apps
