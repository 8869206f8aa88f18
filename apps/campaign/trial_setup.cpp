#include "apps/campaign/trial_setup.hpp"

#include <algorithm>
#include <cmath>

#include "apps/campaign/scenario_text.hpp"
#include "apps/installation.hpp"
#include "apps/run_config.hpp"
#include "apps/text_file.hpp"

namespace hopscotch::apps::campaign {

namespace {

constexpr std::int64_t kCellsTried = 200;  // of a large campaign, when it is read
const std::vector<std::string> kRobots{"hector", "hector-d14", "hector-urdf", "hector-sim"};

/// Draws the factors of one trial and keeps what was drawn.
class Drawer {
 public:
  Drawer(const CampaignSpec& spec, std::int64_t index)
      : spec_(spec),
        place_(place_of(index, spec.cells())),
        levels_(levels_of(spec.factors, place_.cell)) {
    values_.assign(spec.factors.size(), core::kNaN);
  }

  [[nodiscard]] const Factor* find(std::string_view name) const {
    for (const Factor& factor : spec_.factors) {
      if (factor.name == name) return &factor;
    }
    return nullptr;
  }

  [[nodiscard]] bool has(std::string_view name) const { return find(name) != nullptr; }

  /// @pre the campaign has the factor, or it is the choice within a mixture.
  double operator()(std::string_view name, int element = 0) {
    const Factor* factor = find(name);
    if (factor == nullptr) return common_draw(spec_.seed, name, place_.repetition, element);
    const auto i = static_cast<std::size_t>(factor - spec_.factors.data());
    const double value =
        factor_value(*factor, levels_[i],
                     {.seed = spec_.seed, .repetition = place_.repetition, .element = element});
    note(i, value);
    return value;
  }

  /// The value of a factor, or what the scenario has without it.
  void apply(std::string_view name, double& target) {
    if (has(name)) target = (*this)(name);
  }

  [[nodiscard]] std::vector<double> values() const { return values_; }

 private:
  void note(std::size_t i, double value) {
    double& kept = values_[i];
    const bool smaller = smaller_is_harder(spec_.factors[i].name);
    const bool harder = smaller ? value < kept : std::abs(value) > std::abs(kept);
    if (std::isnan(kept) || harder) kept = value;
  }

  const CampaignSpec& spec_;
  TrialPlace place_;
  std::vector<std::size_t> levels_;
  std::vector<double> values_;
};

sim::Scenario terrain_of(const CampaignSpec& spec, Drawer& draw) {
  if (spec.bases.empty()) {
    return family_scenario(spec.family,
                           [&](std::string_view name, int i) { return draw(name, i); });
  }
  const double level = draw.has("scenario") ? draw("scenario") : 0.0;
  return spec.bases.at(static_cast<std::size_t>(std::lround(level)));
}

void apply_friction(Drawer& draw, sim::Scenario& scenario) {
  if (!draw.has("friction")) return;
  const double before = scenario.friction;
  scenario.friction = draw("friction");
  for (sim::Slab& slab : scenario.seen.slabs) {
    if (slab.friction == before) slab.friction = scenario.friction;
  }
}

/// All slabs but the one it starts on may lie elsewhere than they seem.
void apply_surprise(Drawer& draw, sim::Scenario& scenario) {
  if (!draw.has("surprise_height_m")) return;
  scenario.height_surprises.clear();
  const auto start = scenario.seen.slab_at({scenario.start.x, 0.0});
  for (std::size_t slab = 0; slab < scenario.seen.slabs.size(); ++slab) {
    if (slab == start) continue;
    scenario.height_surprises.push_back(
        {.slab = slab, .rise = draw("surprise_height_m", static_cast<int>(slab))});
  }
}

void apply_push(Drawer& draw, sim::Scenario& scenario) {
  if (!draw.has("push.impulse_Ns")) return;
  sim::Push push;
  push.phase = static_cast<core::JumpPhase>(std::lround(draw("push.phase")));
  if (draw.has("push.occurrence")) {
    push.occurrence = static_cast<int>(std::lround(draw("push.occurrence")));
  }
  draw.apply("push.after_s", push.after);
  draw.apply("push.duration_s", push.duration);
  push.impulse[std::lround(draw("push.axis"))] = draw("push.impulse_Ns");
  scenario.pushes.push_back(push);
}

void apply_plant(Drawer& draw, sim::PlantSetup& plant) {
  draw.apply("plant.mass_scale", plant.mass_scale);
  draw.apply("plant.inertia_scale", plant.inertia_scale);
  draw.apply("plant.motor_strength", plant.motor_strength);
  draw.apply("plant.sensor_noise", plant.sensor_noise);
  if (draw.has("plant.latency_ms")) {
    plant.latency_ticks = static_cast<int>(std::lround(draw("plant.latency_ms")));
  }
  if (draw.has("plant.exchange_Hz")) {
    plant.exchange_period = 1 + static_cast<int>(std::lround(draw("plant.exchange_Hz")));
  }
  if (draw.has("plant.robot")) {
    plant.robot = kRobots[static_cast<std::size_t>(std::lround(draw("plant.robot")))];
  }
}

void apply_camera(Drawer& draw, sim::CameraSettings& camera) {
  if (draw.has("camera.noise")) {
    camera.noise = static_cast<sim::CameraNoise>(std::lround(draw("camera.noise")));
  }
  draw.apply("camera.rate_Hz", camera.rate);
  if (draw.has("camera.latency_ms")) camera.latency = 1e-3 * draw("camera.latency_ms");
  draw.apply("camera.x_m", camera.x);
  draw.apply("camera.z_m", camera.z);
  draw.apply("camera.pitch_rad", camera.pitch);
  draw.apply("camera.lost_pixels", camera.lost_pixels);
  draw.apply("camera.lost_frames", camera.lost_frames);
  if (draw.has("camera.time_error_ms")) camera.time_error = 1e-3 * draw("camera.time_error_ms");
  draw.apply("camera.pitch_error_rad", camera.pitch_error);
}

/// Run seeds of different repetitions; below 2^53 so that every reader of JSON keeps them.
std::uint64_t run_seed(const CampaignSpec& spec, std::int64_t repetition) {
  constexpr double kSeeds = 0x1.0p52;
  return static_cast<std::uint64_t>(kSeeds * common_draw(spec.seed, "run", repetition, 0));
}

}  // namespace

TrialMaker::TrialMaker(const CampaignSpec& spec) : spec_(spec) {
  const std::filesystem::path file = config_directory() / "hopscotch.yaml";
  config_text_ = read_file(file);
  config_ = ProgramConfig::load(file);
  std::vector<std::string> names;
  for (const sim::Scenario& base : spec.bases) {
    names.push_back(base.robot);
    names.push_back(base.plant.robot);
  }
  if (names.empty()) names.emplace_back("hector");
  const bool varied = std::any_of(spec.factors.begin(), spec.factors.end(),
                                  [](const Factor& f) { return f.name == "plant.robot"; });
  if (varied) names.insert(names.end(), kRobots.begin(), kRobots.end());
  for (const std::string& name : names) {
    robots_[name] = {robot_text(name), model::RobotParameters::load(robot_file(name))};
  }
  check_cells();
}

/// A campaign that cannot work is refused before it starts.
void TrialMaker::check_cells() const {
  const std::int64_t cells = std::min(spec_.cells(), kCellsTried);
  for (std::int64_t cell = 0; cell < cells; ++cell) (void)setup(cell);
}

TrialSetup TrialMaker::setup(std::int64_t index) const {
  Drawer draw(spec_, index);
  TrialSetup setup;
  setup.index = index;
  setup.seed = run_seed(spec_, place_of(index, spec_.cells()).repetition);
  sim::Scenario scenario = terrain_of(spec_, draw);
  apply_friction(draw, scenario);
  apply_surprise(draw, scenario);
  apply_push(draw, scenario);
  apply_plant(draw, scenario.plant);
  apply_camera(draw, scenario.camera);
  draw.apply("start.yaw_rad", scenario.start.yaw);
  draw.apply("start.drop_m", scenario.start.drop);
  draw.apply("jump_m", setup.jump_length);
  setup.ablation = spec_.ablation;
  if (draw.has("ablation")) {
    setup.ablation = static_cast<core::Ablation>(std::lround(draw("ablation")));
  }
  setup.scenario_text = scenario_text(scenario);
  setup.scenario = sim::Scenario::from_text(setup.scenario_text,
                                            spec_.name + ", trial " + std::to_string(index));
  setup.values = draw.values();
  return setup;
}

RunRequest TrialMaker::request(const TrialSetup& setup, Eyes eyes) const {
  RunRequest request;
  request.scenario = setup.scenario;
  request.config = config_;
  if (!std::isnan(setup.jump_length)) {
    request.config.footstep.preference.nominal_distance = setup.jump_length;
  }
  request.robot = robots_.at(setup.scenario.robot).parameters;
  request.plant_robot = robots_.at(setup.scenario.plant.robot).parameters;
  request.seed = setup.seed;
  request.eyes = eyes;
  request.state = spec_.state;
  request.ablation = setup.ablation;
  return request;
}

RunSources TrialMaker::sources(const TrialSetup& setup) const {
  std::string configuration = config_text_;
  if (!std::isnan(setup.jump_length)) {
    configuration +=
        "# This trial: footstep.preference.nominal_distance_m = " + exact_text(setup.jump_length) +
        "\n";
  }
  return {setup.scenario_text, configuration, robots_.at(setup.scenario.plant.robot).text};
}

std::string TrialMaker::identity() const {
  std::string text = spec_.pairing() + "eyes " + std::to_string(static_cast<int>(spec_.eyes)) +
                     "\nstate " + std::to_string(static_cast<int>(spec_.state)) + "\nablation " +
                     std::string(core::ablation_name(spec_.ablation)) + "\n" + config_text_;
  for (const auto& [name, robot] : robots_) text += name + "\n" + robot.text;
  return fingerprint(text);
}

}  // namespace hopscotch::apps::campaign
