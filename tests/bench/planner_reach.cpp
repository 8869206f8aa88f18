/// Prints which jumps from standing the planner solves, as the table of docs/planner.md.

#include <cstdio>
#include <filesystem>
#include <optional>

#include "core/config_reader.hpp"
#include "planner/jump_planner.hpp"
#include "planner/step_target.hpp"

namespace {

using namespace hopscotch;  // NOLINT: a program of one file

/// "17" iterations, "c" refused by the certificate, "-" no motion found.
void print_cell(planner::JumpPlanner& planner, const planner::PlanRequest& request) {
  const core::Result<core::JumpPlan> plan = planner.plan(request);
  if (plan) {
    std::printf(" %d |", plan->iterations);
  } else {
    std::printf(" %s |", plan.error().reason == core::Reason::certificate_refused ? "c" : "-");
  }
}

}  // namespace

int main() {
  const std::filesystem::path folder = std::filesystem::path(HOPSCOTCH_SOURCE_DIR) / "config";
  const model::RobotParameters robot =
      model::RobotParameters::load(folder / "robots" / "hector.yaml");
  const core::ConfigReader root = core::ConfigReader::from_file(folder / "hopscotch.yaml");
  const model::StandPosture posture =
      model::StandPosture::load(root.section("model").section("stand_posture"));
  const std::optional<model::StandPose> pose = model::stand_pose(robot, posture);
  if (!pose) return 1;
  planner::JumpPlanner planner(planner::PlannerConfig::load(root.section("planner")), robot);
  std::printf("| height | 0.20 | 0.25 | 0.30 | 0.35 | 0.40 | 0.45 | 0.50 | 0.55 | 0.60 | 0.65 |\n");
  std::printf("| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |\n");
  for (const double height :
       {-0.30, -0.25, -0.20, -0.15, -0.10, -0.05, 0.0, 0.05, 0.10, 0.15, 0.20, 0.22, 0.25}) {
    std::printf("| %+.2f |", height);
    for (int centimetres = 20; centimetres <= 65; centimetres += 5) {
      const double distance = 0.01 * centimetres;
      print_cell(planner,
                 {.start = planner::standing_state(*pose),
                  .target = planner::step_target({.distance = distance,
                                                  .height = height,
                                                  .edge = planner::default_edge(distance, height)},
                                                 robot),
                  .final_posture = posture});
    }
    std::printf("\n");
  }
  return 0;
}
