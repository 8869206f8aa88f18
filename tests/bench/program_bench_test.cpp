#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <ostream>
#include <string>
#include <vector>

#include "tests/scenario/program.hpp"

namespace hopscotch {
namespace {

using nlohmann::json;

json bench(const std::string& arguments) {
  const apps::Answer answer = apps::call("bench " + arguments + " --json 2>/dev/null");
  EXPECT_EQ(answer.status, 0) << answer.output;
  return json::parse(answer.output);
}

struct BenchCase {
  const char* arguments;
  std::vector<std::string> percentiles;  ///< Keys of groups {p50, p99, max}.
  std::vector<std::string> others;
};

// NOLINTNEXTLINE(readability-identifier-naming): the name that GoogleTest looks for
void PrintTo(const BenchCase& tested, std::ostream* out) {
  *out << tested.arguments;
}

class BenchJson : public ::testing::TestWithParam<BenchCase> {};

/// How long anything takes is for people to judge.
TEST_P(BenchJson, HasTheKeysThatScriptsCountOn) {
  const json measured = bench(GetParam().arguments);
  EXPECT_EQ(measured.at("schema"), "hopscotch.bench/1");
  EXPECT_FALSE(measured.at("machine").get<std::string>().empty());
  EXPECT_GT(measured.at("n").get<int>(), 0);
  for (const std::string& key : GetParam().percentiles) {
    const json& group = measured.at(key);
    EXPECT_GT(group.at("p50").get<double>(), 0.0) << key;
    EXPECT_GE(group.at("p99").get<double>(), group.at("p50").get<double>()) << key;
    EXPECT_GE(group.at("max").get<double>(), group.at("p99").get<double>()) << key;
  }
  for (const std::string& key : GetParam().others) EXPECT_TRUE(measured.contains(key)) << key;
}

INSTANTIATE_TEST_SUITE_P(
    Program, BenchJson,
    ::testing::Values(
        BenchCase{"perception", {"frame_ms", "octomap_ms", "render_ms"}, {"memory_MiB"}},
        BenchCase{"estimator --jumps 1",
                  {"update_us", "touchdown_ms"},
                  {"takeoff_speed_rmse_mps", "pitch_rmse_rad", "landing_rmse_m", "false_touchdowns",
                   "jumps"}},
        BenchCase{"planner --targets 10",
                  {"cold_ms", "warm_ms", "iteration_ms", "ipopt_ms"},
                  {"success", "targets", "shares"}},
        BenchCase{"mpc", {"cold_us", "warm_us"}, {"objective_error_max", "failures"}},
        BenchCase{"tick", {"tick_us"}, {"allocations"}}));

TEST(Bench, PlannerSolvesEachOfAFewTargets) {
  const json planner = bench("planner --targets 10");
  EXPECT_EQ(planner.at("targets"), 10);
  EXPECT_EQ(planner.at("success"), 1.0);
}

TEST(Bench, MpcFindsTheReferenceOptima) {
  const json mpc = bench("mpc");
  EXPECT_EQ(mpc.at("failures"), 0);
  EXPECT_LT(mpc.at("objective_error_max").get<double>(), 1e-6);  // the solver's gap is 1e-8
}

TEST(Bench, TickTakesNothingFromTheHeap) {
  EXPECT_EQ(bench("tick").at("allocations"), 0);
}

}  // namespace
}  // namespace hopscotch
