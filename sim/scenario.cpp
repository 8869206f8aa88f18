#include "sim/scenario.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/input_file.hpp"

namespace hopscotch::sim {
namespace {

using core::ConfigReader;
using core::Range;

constexpr double kFarthest = 1000.0;      // [m] keeps all geometry well inside double and float
constexpr double kShortestSlab = 0.02;    // [m]
constexpr double kSteepest = 0.5;         // [rad] beyond what any sole grips
constexpr double kHighestSurprise = 0.5;  // [m]
constexpr std::size_t kMostSlabs = 200;
constexpr int kMostOccurrences = 1000;

constexpr std::string_view kAbovePit =
    "must keep the slab's whole top above the pit floor (pit_depth_m)";

const std::vector<std::string> kRobots{"hector", "hector-d14", "hector-urdf", "hector-sim"};

std::string read_robot(const ConfigReader& reader, const std::string& fallback) {
  if (!reader.has("robot")) return fallback;
  return kRobots[static_cast<std::size_t>(reader.choice("robot", kRobots))];
}

CameraSettings read_camera(const ConfigReader& reader) {
  CameraSettings camera;
  if (reader.has("noise")) {
    camera.noise = static_cast<CameraNoise>(reader.choice("noise", {"none", "d435"}));
  }
  camera.width = reader.integer_or("width", camera.width, 16, 1920);
  camera.height = reader.integer_or("height", camera.height, 16, 1080);
  camera.rate = reader.number_or("rate_Hz", camera.rate, Range::closed(1.0, 200.0));
  camera.latency =
      1e-3 * reader.number_or("latency_ms", 1e3 * camera.latency, Range::closed(0.0, 1000.0));
  camera.x = reader.number_or("x_m", camera.x, Range::closed(-0.5, 0.5));
  camera.z = reader.number_or("z_m", camera.z, Range::closed(-0.5, 0.5));
  camera.pitch = reader.number_or("pitch_rad", camera.pitch, Range::closed(-1.5, 1.5));
  camera.lost_pixels = reader.number_or("lost_pixels", 0.0, Range::closed(0.0, 1.0));
  camera.lost_frames = reader.number_or("lost_frames", 0.0, Range::closed(0.0, 1.0));
  camera.time_error = 1e-3 * reader.number_or("time_error_ms", 0.0, Range::closed(-200.0, 200.0));
  camera.pitch_error = reader.number_or("pitch_error_rad", 0.0, Range::closed(-0.3, 0.3));
  reader.finish();
  return camera;
}

/// [lowest, highest] of a slab along one axis, long enough to stand on.
Eigen::Vector2d read_extent(const ConfigReader& reader, std::string_view key) {
  Eigen::Vector2d extent = reader.vector<2>(key, Range::closed(-kFarthest, kFarthest));
  if (extent[1] - extent[0] < kShortestSlab) {
    reader.reject(key, "must rise by at least 0.02 m from its first to its second number");
  }
  return extent;
}

Slab read_slab(const ConfigReader& reader, const Scenario& scenario) {
  const Eigen::Vector2d x = read_extent(reader, "x_m");
  const Eigen::Vector2d y =
      reader.has("y_m") ? read_extent(reader, "y_m") : Eigen::Vector2d(-0.6, 0.6);
  Slab slab;
  slab.centre = 0.5 * Eigen::Vector2d(x[0] + x[1], y[0] + y[1]);
  slab.half_size = 0.5 * Eigen::Vector2d(x[1] - x[0], y[1] - y[0]);
  slab.top = reader.number_or("top_m", 0.0, Range::closed(-10.0, 10.0));
  slab.slope = reader.number_or("slope_rad", 0.0, Range::closed(-kSteepest, kSteepest));
  slab.yaw = reader.number_or("yaw_rad", 0.0, Range::closed(-M_PI, M_PI));
  slab.friction = reader.number_or("friction", scenario.friction, Range::above(0.0, 2.0));
  reader.finish();
  if (slab.lowest() <= -scenario.seen.pit_depth) reader.reject("top_m", kAbovePit);
  return slab;
}

std::vector<Slab> read_slabs(const ConfigReader& reader, const Scenario& scenario) {
  const std::vector<ConfigReader> items = reader.list("slabs");
  if (items.empty()) reader.reject("slabs", "must have at least one slab");
  if (items.size() > kMostSlabs) reader.reject("slabs", "must have at most 200 slabs");
  std::vector<Slab> slabs;
  for (const ConfigReader& item : items) {
    const Slab slab = read_slab(item, scenario);
    for (std::size_t other = 0; other < slabs.size(); ++other) {
      if (overlap(slab, slabs[other])) {
        item.reject("x_m", "must not overlap slab " + std::to_string(other));
      }
    }
    slabs.push_back(slab);
  }
  return slabs;
}

StartPlace read_start(const ConfigReader& reader) {
  StartPlace start;
  start.x = reader.number_or("x_m", start.x, Range::closed(-kFarthest, kFarthest));
  start.yaw = reader.number_or("yaw_rad", start.yaw, Range::closed(-M_PI, M_PI));
  start.drop = reader.number_or("drop_m", start.drop, Range::closed(0.0, 2.0));
  reader.finish();
  return start;
}

/// `goal: {x_m: 3.0}`, `goal: {jumps: 5}` or `jumps: 5`; at most one of them.
Goal read_goal(const ConfigReader& reader) {
  constexpr int kMostJumps = 1000000;
  constexpr double kDefaultGoal = 3.0;  // [m] as documented
  Goal goal;
  if (reader.has("jumps")) goal.jumps = reader.integer("jumps", 1, kMostJumps);
  if (const auto section = reader.section_if("goal")) {
    if (goal.jumps) reader.reject("jumps", "must not stand beside goal");
    if (section->has("jumps") && section->has("x_m")) {
      section->reject("jumps", "must not stand beside x_m");
    }
    if (section->has("jumps")) goal.jumps = section->integer("jumps", 1, kMostJumps);
    if (section->has("x_m")) goal.x = section->number("x_m", Range::closed(-kFarthest, kFarthest));
    section->finish();
  }
  if (!goal.x && !goal.jumps) goal.x = kDefaultGoal;
  return goal;
}

core::TargetOverride read_target(const ConfigReader& reader) {
  constexpr double kLongest = 1.0;  // [m] more than any jump
  core::TargetOverride target;
  target.distance = reader.number("distance_m", Range::above(0.0, kLongest));
  target.height = reader.number_or("height_m", target.height, Range::closed(-kLongest, kLongest));
  target.lateral = reader.number_or("lateral_m", 0.0, Range::closed(-kLongest, kLongest));
  target.yaw = reader.number_or("yaw_rad", 0.0, Range::closed(-M_PI, M_PI));
  reader.finish();
  return target;
}

core::JumpPhase read_phase(const ConfigReader& reader) {
  return static_cast<core::JumpPhase>(reader.choice("phase", {"takeoff", "flight", "landing"}));
}

Push read_push(const ConfigReader& reader) {
  Push push;
  if (reader.has("phase") && reader.has("at_s")) {
    reader.reject("at_s", "must not stand beside phase");
  }
  if (reader.has("at_s")) {
    push.at = reader.number("at_s", Range::closed(0.0, 3600.0));
  } else {
    push.phase = read_phase(reader);
    push.occurrence = reader.integer_or("occurrence", 1, 1, kMostOccurrences);
    push.after = reader.number_or("after_s", push.after, Range::closed(0.0, 3600.0));
  }
  push.duration = reader.number_or("duration_s", push.duration, Range::closed(0.001, 60.0));
  push.impulse = reader.vector<3>("impulse_Ns", Range::closed(-100.0, 100.0));
  reader.finish();
  return push;
}

HeightSurprise read_height_surprise(const ConfigReader& reader, const Terrain& seen) {
  const int last = static_cast<int>(seen.slabs.size()) - 1;
  HeightSurprise surprise;
  surprise.slab = static_cast<std::size_t>(reader.integer("slab", 0, last));
  surprise.rise = reader.number("top_m", Range::closed(-kHighestSurprise, kHighestSurprise));
  reader.finish();
  if (seen.slabs[surprise.slab].lowest() + surprise.rise <= -seen.pit_depth) {
    reader.reject("top_m", kAbovePit);
  }
  return surprise;
}

void read_surprises(const ConfigReader& reader, Scenario& scenario) {
  for (const ConfigReader& item : reader.list_if("surprises")) {
    if (const auto push = item.section_if("push")) {
      scenario.pushes.push_back(read_push(*push));
      item.finish();
      continue;
    }
    const HeightSurprise surprise = read_height_surprise(item, scenario.seen);
    const bool again =
        std::any_of(scenario.height_surprises.begin(), scenario.height_surprises.end(),
                    [&](const HeightSurprise& earlier) { return earlier.slab == surprise.slab; });
    if (again) item.reject("slab", "must not be surprised twice");
    scenario.height_surprises.push_back(surprise);
  }
}

int read_latency_ticks(const ConfigReader& reader, int fallback) {
  constexpr double kTickMs = 1.0;
  const double latency_ms =
      reader.number_or("latency_ms", fallback * kTickMs, Range::closed(0.0, 50.0));
  const double ticks = std::round(latency_ms / kTickMs);
  if (std::abs(latency_ms - ticks * kTickMs) > 1e-9) {
    reader.reject("latency_ms", "must be a whole number of ticks of 1 ms");
  }
  return static_cast<int>(ticks);
}

int read_exchange_period(const ConfigReader& reader) {
  if (!reader.has("exchange_Hz")) return 1;
  return 1 + reader.choice("exchange_Hz", {"1000", "500"});
}

PlantSetup read_plant(const ConfigReader& reader, PlantSetup plant) {
  plant.robot = read_robot(reader, plant.robot);
  plant.mass_scale = reader.number_or("mass_scale", plant.mass_scale, Range::closed(0.5, 2.0));
  plant.inertia_scale =
      reader.number_or("inertia_scale", plant.inertia_scale, Range::closed(0.5, 2.0));
  plant.motor_strength =
      reader.number_or("motor_strength", plant.motor_strength, Range::above(0.0, 2.0));
  plant.latency_ticks = read_latency_ticks(reader, plant.latency_ticks);
  plant.exchange_period = read_exchange_period(reader);
  plant.sensor_noise =
      reader.number_or("sensor_noise", plant.sensor_noise, Range::closed(0.0, 10.0));
  reader.finish();
  return plant;
}

/// Both soles must be on one slab, the one under their mid-point.
void require_start_on_slab(const ConfigReader& reader, const Scenario& scenario) {
  const Eigen::Vector2d middle(scenario.start.x, 0.0);
  const std::optional<std::size_t> slab = scenario.seen.slab_at(middle);
  if (!slab) reader.reject("start", "must lie on a slab, not over the pit");
  const Eigen::Vector2d ahead(std::cos(scenario.start.yaw), std::sin(scenario.start.yaw));
  const Eigen::Vector2d left(-ahead.y(), ahead.x());
  const double outer = StanceOutline::kHalfSpacing + StanceOutline::kHalfWidth;
  for (const double x : {-StanceOutline::kHalfLength, StanceOutline::kHalfLength}) {
    for (const double y : {-outer, outer}) {
      if (!scenario.seen.slabs[*slab].contains(middle + x * ahead + y * left)) {
        reader.reject("start", "must put both soles wholly on slab " + std::to_string(*slab));
      }
    }
  }
}

}  // namespace

Terrain Scenario::true_terrain() const {
  Terrain terrain = seen;
  for (const HeightSurprise& surprise : height_surprises) {
    terrain.slabs[surprise.slab].top += surprise.rise;
  }
  return terrain;
}

Scenario Scenario::from_reader(const ConfigReader& reader) {
  Scenario scenario;
  scenario.name = core::read_plain_name(reader, "name");
  scenario.robot = read_robot(reader, scenario.robot);
  scenario.friction = reader.number_or("friction", scenario.friction, Range::above(0.0, 2.0));
  scenario.seen.pit_depth =
      reader.number_or("pit_depth_m", scenario.seen.pit_depth, Range::above(0.0, 10.0));
  if (const auto camera = reader.section_if("camera")) scenario.camera = read_camera(*camera);
  scenario.seen.slabs = read_slabs(reader, scenario);  // after friction and pit depth
  if (const auto start = reader.section_if("start")) scenario.start = read_start(*start);
  scenario.goal = read_goal(reader);
  for (const ConfigReader& item : reader.list_if("targets")) {
    scenario.targets.push_back(read_target(item));
  }
  read_surprises(reader, scenario);
  scenario.plant.robot = scenario.robot;
  if (const auto plant = reader.section_if("plant")) {
    scenario.plant = read_plant(*plant, scenario.plant);
  }
  reader.finish();
  require_start_on_slab(reader, scenario);
  return scenario;
}

Scenario Scenario::load(const std::filesystem::path& file) {
  return from_reader(ConfigReader::from_file(file));
}

Scenario Scenario::from_text(std::string_view text, std::string name_of_text) {
  return from_reader(ConfigReader::from_text(text, std::move(name_of_text)));
}

}  // namespace hopscotch::sim
