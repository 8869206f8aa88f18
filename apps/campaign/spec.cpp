#include "apps/campaign/spec.hpp"

#include <algorithm>

#include "apps/campaign/scenario_text.hpp"
#include "core/input_file.hpp"

namespace hopscotch::apps::campaign {

using core::ConfigReader;
using core::Range;
namespace fs = std::filesystem;

namespace {

constexpr int kMostTrials = 10'000'000;
constexpr std::int64_t kMostCells = 10'000;
constexpr std::int64_t kMostRows = 100'000'000;  // one byte of memory each while running
constexpr double kLongest = 86'400.0;            // [s]

/// What `vary` knows beside `push`. Rules of the ranges are those of the scenario file.
const std::vector<FactorRule>& vary_rules() {
  static const std::vector<FactorRule> rules{
      {.name = "friction", .range = Range::above(0.0, 2.0)},
      {.name = "plant.mass_scale", .range = Range::closed(0.5, 2.0)},
      {.name = "plant.inertia_scale", .range = Range::closed(0.5, 2.0)},
      {.name = "plant.motor_strength", .range = Range::above(0.0, 2.0)},
      {.name = "plant.latency_ms", .range = Range::closed(0.0, 50.0), .step = 1.0},
      {.name = "plant.exchange_Hz", .choices = {"1000", "500"}},
      {.name = "plant.sensor_noise", .range = Range::closed(0.0, 10.0)},
      {.name = "plant.robot", .choices = {"hector", "hector-d14", "hector-urdf", "hector-sim"}},
      {.name = "surprise_height_m", .range = Range::closed(-0.5, 0.5)},
      {.name = "start.yaw_rad", .range = Range::closed(-0.5, 0.5)},
      {.name = "start.drop_m", .range = Range::closed(0.0, 2.0)},
      {.name = "camera.noise", .choices = {"none", "d435"}},
      {.name = "camera.rate_Hz", .range = Range::closed(1.0, 200.0)},
      {.name = "camera.latency_ms", .range = Range::closed(0.0, 1000.0)},
      {.name = "camera.x_m", .range = Range::closed(-0.5, 0.5)},
      {.name = "camera.z_m", .range = Range::closed(-0.5, 0.5)},
      {.name = "camera.pitch_rad", .range = Range::closed(-1.5, 1.5)},
      {.name = "camera.lost_pixels", .range = Range::closed(0.0, 1.0)},
      {.name = "camera.lost_frames", .range = Range::closed(0.0, 1.0)},
      {.name = "camera.time_error_ms", .range = Range::closed(-200.0, 200.0)},
      {.name = "camera.pitch_error_rad", .range = Range::closed(-0.3, 0.3)},
      {.name = "ablation", .choices = {core::kAblationNames.begin(), core::kAblationNames.end()}},
  };
  return rules;
}

const std::vector<FactorRule>& push_rules() {
  static const std::vector<FactorRule> rules{
      {.name = "phase", .choices = {"takeoff", "flight", "landing"}},
      {.name = "axis", .choices = {"x", "y", "z"}},
      {.name = "impulse_Ns", .range = Range::closed(-100.0, 100.0)},
      {.name = "after_s", .range = Range::closed(0.0, 60.0)},
      {.name = "duration_s", .range = Range::closed(0.001, 10.0)},
      {.name = "occurrence", .range = Range::closed(1.0, 1000.0), .step = 1.0},
  };
  return rules;
}

void read_push(const FactorSection& section, std::vector<Factor>& factors) {
  const ConfigReader& push = section.reader;
  for (const std::string_view needed : {"phase", "axis", "impulse_Ns"}) {
    if (!push.has(needed)) push.reject(needed, "is missing");
  }
  for (const FactorRule& rule : push_rules()) {
    if (push.has(rule.name)) factors.push_back(read_factor(section, rule));
  }
  push.finish();
}

void read_vary(const FactorSection& section, std::vector<Factor>& factors) {
  for (const std::string& key : section.reader.keys()) {
    if (key == "push") {
      read_push(section.below("push", "push."), factors);
      continue;
    }
    const auto rule = std::find_if(vary_rules().begin(), vary_rules().end(),
                                   [&](const FactorRule& known) { return known.name == key; });
    if (rule == vary_rules().end()) {
      std::string known = "is no factor; known are push";
      for (const FactorRule& each : vary_rules()) known += ", " + std::string(each.name);
      section.reader.reject(key, known);
    }
    factors.push_back(read_factor(section, *rule));
  }
}

fs::path scenario_file(const std::string& name, const fs::path& campaign_file) {
  const fs::path beside = campaign_file.parent_path() / name;
  std::error_code error;
  return fs::is_regular_file(beside, error) ? beside : fs::path(name);
}

/// Several scenario files, one cell each.
void read_files(const FactorSection& section, const fs::path& file, CampaignSpec& spec) {
  const ConfigReader& reader = section.reader;
  Factor factor;
  factor.name = "scenario";
  factor.kind = Factor::Kind::grid;
  factor.words = true;
  for (const std::string& name : section.words("grid")) {
    spec.bases.push_back(sim::Scenario::load(scenario_file(name, file)));
    const std::string& label = spec.bases.back().name;
    if (std::find(factor.labels.begin(), factor.labels.end(), label) != factor.labels.end()) {
      reader.reject("grid", "must not hold two scenarios of one name");
    }
    factor.values.push_back(static_cast<double>(factor.labels.size()));
    factor.labels.push_back(label);
  }
  for (const std::string& key : reader.keys()) {
    if (key != "grid") reader.reject(key, "is not a known key here");
  }
  spec.factors.push_back(factor);
  spec.scenario_name = "files";
}

/// `scenario: FILE.yaml`, `scenario: {grid: [FILE.yaml, ...]}` or `scenario: {family: ...}`.
void read_scenario(const FactorSection& root, const fs::path& file, CampaignSpec& spec) {
  if (root.value("scenario").shape == core::ConfigShape::mapping) {
    const FactorSection section = root.below("scenario", "");
    if (section.reader.has("grid")) {
      read_files(section, file, spec);
      return;
    }
    spec.family = read_family(section, spec.factors);
    spec.scenario_name = family_name(spec.family.family);
    return;
  }
  spec.bases = {sim::Scenario::load(scenario_file(root.reader.text("scenario"), file))};
  spec.scenario_name = spec.bases.front().name;
}

StopRule read_stop(const ConfigReader& reader) {
  StopRule stop;
  stop.half_width = reader.number("half_width", Range::closed(0.001, 0.5));
  stop.at_least = reader.integer_or("at_least", stop.at_least, 10, kMostTrials);
  reader.finish();
  return stop;
}

KeepRule read_keep(const ConfigReader& reader) {
  KeepRule keep;
  keep.failures = reader.integer_or("failures", keep.failures, 0, 1000);
  keep.successes = reader.integer_or("successes", keep.successes, 0, 1000);
  reader.finish();
  return keep;
}

/// A height nobody was told of needs ground beside the ground one stands on.
void require_meaning(const ConfigReader& reader, const CampaignSpec& spec) {
  const auto varied = [&](std::string_view name) {
    return std::any_of(spec.factors.begin(), spec.factors.end(),
                       [&](const Factor& factor) { return factor.name == name; });
  };
  const bool one_slab =
      spec.bases.empty()
          ? spec.family.family == Family::flat || spec.family.family == Family::drops
          : std::any_of(spec.bases.begin(), spec.bases.end(),
                        [](const sim::Scenario& base) { return base.seen.slabs.size() < 2; });
  if (one_slab && varied("surprise_height_m")) {
    reader.reject("vary", "must not hold surprise_height_m: the scenario has one slab only");
  }
  if (spec.ablation != core::Ablation::none && varied("ablation")) {
    reader.reject("ablation", "must not stand beside vary.ablation");
  }
  if (spec.cells() > kMostCells) reader.reject("vary", "must span at most 10000 cells");
  if (spec.cells() * spec.trials > kMostRows) {
    reader.reject("trials", "must not make more than 1e8 trials of all cells together");
  }
}

}  // namespace

std::int64_t CampaignSpec::cells() const {
  std::int64_t count = 1;
  for (const Factor& factor : factors) {
    count *= static_cast<std::int64_t>(factor.levels());
    if (count > kMostCells) return count;
  }
  return count;
}

std::string CampaignSpec::pairing() const {
  std::string text = "seed " + std::to_string(seed) + "\nscenario " + scenario_name + " " +
                     std::to_string(family.treads) + " " + std::to_string(family.jumps) + "\n";
  for (const sim::Scenario& base : bases) text += scenario_text(base);
  for (const Factor& factor : factors) text += canonical(factor) + "\n";
  return text;
}

CampaignSpec CampaignSpec::from_text(std::string_view text, const fs::path& file) {
  const FactorSection root{ConfigReader::from_text(text, file.string()), std::string(text), {}, ""};
  const ConfigReader& reader = root.reader;
  CampaignSpec spec;
  spec.source = text;
  spec.name = core::read_plain_name(reader, "name");
  read_scenario(root, file, spec);
  if (reader.has("perception")) {
    spec.eyes = static_cast<Eyes>(reader.choice("perception", {"camera", "truth"}));
  }
  if (reader.has("state")) {
    spec.state = static_cast<StateSource>(reader.choice("state", {"estimate", "truth"}));
  }
  if (reader.has("ablation")) {
    spec.ablation = static_cast<core::Ablation>(
        reader.choice("ablation", {core::kAblationNames.begin(), core::kAblationNames.end()}));
  }
  spec.trials = reader.integer("trials", 1, kMostTrials);
  spec.seed = static_cast<std::uint64_t>(reader.integer_or("seed", 1, 0, 2'000'000'000));
  if (reader.has("vary")) read_vary(root.below("vary", ""), spec.factors);
  if (const auto stop = reader.section_if("stop")) spec.stop = read_stop(*stop);
  if (const auto keep = reader.section_if("keep")) spec.keep = read_keep(*keep);
  spec.trial_timeout =
      reader.number_or("trial_timeout_s", spec.trial_timeout, Range::closed(0.01, kLongest));
  reader.finish();
  require_meaning(reader, spec);
  return spec;
}

CampaignSpec CampaignSpec::load(const fs::path& file) {
  return from_text(core::read_input_file(file), file);
}

}  // namespace hopscotch::apps::campaign
