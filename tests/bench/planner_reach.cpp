/// The reachability map of the docs, in two steps:
///   planner_reach map      prints which jumps the planner plans, as CSV: the knee's largest speed
///                          [rad/s], start, distance and height [m], edge ahead of the toes [m],
///                          planned (1) or not (0)
///   planner_reach picture  draws such a map from the standard input as SVG
/// Jumps of which the edge would lie under a sole are left out. Some five minutes of a core.

#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <map>
#include <string>
#include <vector>

#include "core/config_reader.hpp"
#include "planner/jump_planner.hpp"
#include "planner/step_target.hpp"

namespace {

using namespace hopscotch;           // NOLINT: a program of one file
using namespace hopscotch::planner;  // NOLINT

constexpr std::array<double, 3> kKnees{10.5, 14.0, 21.0};  // [rad/s]
constexpr std::array<StartKind, 3> kStarts{StartKind::stand, StartKind::low, StartKind::moving};
constexpr std::array<double, 3> kAheadOfToes{0.015, 0.05, 0.10};  // [m]
constexpr double kSoleRoom = 0.03;                                // from an edge to the heels [m]
// The grid in centimetres.
constexpr int kNearest = 15, kFarthest = 75, kLowest = -30, kHighest = 40, kStep = 5;

/// The robot with a knee that turns so fast: its torque-speed line is scaled with it.
model::RobotParameters with_knee(model::RobotParameters robot, double speed) {
  model::MotorParameters& knee = robot.motors[static_cast<std::size_t>(core::Joint::knee)];
  knee.corner_speed *= speed / knee.speed_max;
  knee.speed_max = speed;
  return robot;
}

struct Setup {
  model::RobotParameters robot;
  model::StandPosture posture;
  JumpPlanner planner;
};

void print_row(Setup& setup, double knee, StartKind start, StepRequest step, double ahead) {
  const bool planned = setup.planner
                           .plan({.start = start_state(start, setup.robot, setup.posture).value(),
                                  .target = step_target(step, setup.robot),
                                  .final_posture = setup.posture})
                           .has_value();
  std::printf("%.1f,%s,%.2f,%.2f,%.3f,%d\n", knee, std::string(start_kind_name(start)).c_str(),
              step.distance, step.height, ahead, planned ? 1 : 0);
  std::fflush(stdout);
}

void print_jumps(Setup& setup, double knee, StartKind start) {
  const double half_sole = 0.5 * (setup.robot.toe + setup.robot.heel);
  for (int up = kLowest; up <= kHighest; up += kStep) {
    for (int along = kNearest; along <= kFarthest; along += kStep) {
      StepRequest step{.distance = 0.01 * along, .height = 0.01 * up};
      if (up == 0) {
        print_row(setup, knee, start, step, 0.0);
        continue;
      }
      for (const double ahead : kAheadOfToes) {
        step.edge = half_sole + ahead;
        if (step.edge > step.distance - half_sole - kSoleRoom) continue;
        print_row(setup, knee, start, step, ahead);
      }
    }
  }
}

int print_map() {
  const std::filesystem::path folder = std::filesystem::path(HOPSCOTCH_SOURCE_DIR) / "config";
  const core::ConfigReader root = core::ConfigReader::from_file(folder / "hopscotch.yaml");
  std::printf("knee_radps,start,distance_m,height_m,edge_ahead_of_toes_m,planned\n");
  for (const double knee : kKnees) {
    const model::RobotParameters robot =
        with_knee(model::RobotParameters::load(folder / "robots" / "hector.yaml"), knee);
    Setup setup{robot, model::StandPosture::load(root.section("model").section("stand_posture")),
                JumpPlanner(PlannerConfig::load(root.section("planner")), robot)};
    for (const StartKind start : kStarts) print_jumps(setup, knee, start);
  }
  return EXIT_SUCCESS;
}

/// What was tried and planned of one distance and height, with whatever edge.
struct Cell {
  int tried = 0;
  int planned = 0;
};
/// By distance and height in centimetres.
using Panel = std::map<std::pair<int, int>, Cell>;

std::map<std::string, Panel> read_map() {
  std::map<std::string, Panel> panels;  // by "KNEE,START"
  std::string line;
  std::getline(std::cin, line);
  while (std::getline(std::cin, line)) {
    double knee = 0.0, distance = 0.0, height = 0.0, ahead = 0.0;
    int planned = 0;
    std::array<char, 16> start{};
    if (std::sscanf(line.c_str(), "%lf,%15[a-z],%lf,%lf,%lf,%d", &knee, start.data(), &distance,
                    &height, &ahead, &planned) != 6) {
      throw core::ConfigError("not a row of the map: " + line);
    }
    const std::string name = line.substr(0, line.find(',')) + "," + start.data();
    Cell& cell = panels[name][{static_cast<int>(std::lround(100.0 * distance)),
                               static_cast<int>(std::lround(100.0 * height))}];
    ++cell.tried;
    cell.planned += planned;
  }
  return panels;
}

void draw_panel(const Panel& panel, int left, int top, const std::string& title) {
  constexpr int kCell = 14;  // [px]
  constexpr int kBottom = (kHighest - kLowest) / kStep * kCell;
  std::printf("<g transform='translate(%d %d)'><text x='0' y='-8' class='t'>%s</text>\n", left, top,
              title.c_str());
  for (const auto& [place, cell] : panel) {
    const int x = (place.first - kNearest) / kStep * kCell;
    const int y = (kHighest - place.second) / kStep * kCell;
    const char* const colour = cell.planned == 0            ? "#eceff1"
                               : cell.planned == cell.tried ? "#1f6f8b"
                                                            : "#99c1cf";
    std::printf("<rect x='%d' y='%d' width='%d' height='%d' fill='%s'/>\n", x, y, kCell - 1,
                kCell - 1, colour);
  }
  for (const int up : {-30, -20, -10, 0, 10, 20, 30, 40}) {
    std::printf("<text x='-6' y='%d' text-anchor='end'>%+.1f</text>\n",
                (kHighest - up) / kStep * kCell + 10, 0.01 * up);
  }
  for (int along = kNearest; along <= kFarthest; along += 15) {
    std::printf("<text x='%d' y='%d' text-anchor='middle'>%.2f</text>\n",
                (along - kNearest) / kStep * kCell + kCell / 2, kBottom + 27, 0.01 * along);
  }
  std::printf("</g>\n");
}

int draw_picture() {
  constexpr int kWide = 250, kHigh = 290, kLeft = 50, kTop = 70;  // [px]
  const std::map<std::string, Panel> panels = read_map();
  std::printf(
      "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 %d %d' font-family='sans-serif' "
      "font-size='10' fill='#333'>\n<style>.t{font-size:12px;font-weight:bold}</style>\n"
      "<rect width='100%%' height='100%%' fill='#fff'/>\n"
      "<text x='20' y='22' class='t'>Jumps that are planned and certified: height over distance "
      "[m]</text>\n<text x='20' y='40'>dark: with the edge 1.5, 5 and 10 cm ahead of the toes; "
      "light: with some of them; grey: with none</text>\n",
      kLeft + 3 * kWide, kTop + 3 * kHigh);
  int column = 0;
  for (const double knee : kKnees) {
    int row = 0;
    for (const StartKind start : kStarts) {
      std::array<char, 16> speed{};
      std::snprintf(speed.data(), speed.size(), "%.1f", knee);
      const std::string name(start_kind_name(start));
      const auto found = panels.find(std::string(speed.data()) + "," + name);
      if (found != panels.end()) {
        draw_panel(found->second, kLeft + column * kWide, kTop + row * kHigh,
                   std::string("knee ") + speed.data() + " rad/s, from " + name);
      }
      ++row;
    }
    ++column;
  }
  std::printf("</svg>\n");
  return EXIT_SUCCESS;
}

}  // namespace

int main(int argc, char** argv) {
  const std::string mode = argc == 2 ? argv[1] : "";
  if (mode == "map") return print_map();
  if (mode == "picture") return draw_picture();
  std::fprintf(stderr, "usage: planner_reach map | picture < MAP\n");
  return EXIT_FAILURE;
}
