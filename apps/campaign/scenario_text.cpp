#include "apps/campaign/scenario_text.hpp"

#include <array>
#include <cmath>

#include "apps/campaign/factor.hpp"
#include "core/jump_plan.hpp"

namespace hopscotch::apps::campaign {

namespace {

/// Ends of a slab, to a nanometre: neighbours that touch are still found to touch.
std::string extent(double low, double high) {
  constexpr double kNano = 1e9;
  const auto rounded = [](double x) { return exact_text(std::round(x * kNano) / kNano); };
  return "[" + rounded(low) + ", " + rounded(high) + "]";
}

std::string slab_text(const sim::Slab& slab) {
  const Eigen::Vector2d low = slab.centre - slab.half_size;
  const Eigen::Vector2d high = slab.centre + slab.half_size;
  return "  - {x_m: " + extent(low.x(), high.x()) + ", y_m: " + extent(low.y(), high.y()) +
         ", top_m: " + exact_text(slab.top) + ", slope_rad: " + exact_text(slab.slope) +
         ", yaw_rad: " + exact_text(slab.yaw) + ", friction: " + exact_text(slab.friction) + "}\n";
}

std::string push_text(const sim::Push& push) {
  static constexpr std::array<const char*, 3> kPhases{"takeoff", "flight", "landing"};
  std::string text = "  - {push: {";
  if (push.phase) {
    text += std::string("phase: ") + kPhases[static_cast<std::size_t>(*push.phase)] +
            ", occurrence: " + std::to_string(push.occurrence) +
            ", after_s: " + exact_text(push.after);
  } else {
    text += "at_s: " + exact_text(push.at);
  }
  return text + ", duration_s: " + exact_text(push.duration) + ", impulse_Ns: [" +
         exact_text(push.impulse.x()) + ", " + exact_text(push.impulse.y()) + ", " +
         exact_text(push.impulse.z()) + "]}}\n";
}

std::string camera_text(const sim::CameraSettings& camera) {
  return std::string("camera: {noise: ") +
         (camera.noise == sim::CameraNoise::d435 ? "d435" : "none") +
         ", width: " + std::to_string(camera.width) + ", height: " + std::to_string(camera.height) +
         ", rate_Hz: " + exact_text(camera.rate) +
         ", latency_ms: " + exact_text(1e3 * camera.latency) + ", x_m: " + exact_text(camera.x) +
         ", z_m: " + exact_text(camera.z) + ", pitch_rad: " + exact_text(camera.pitch) +
         ", lost_pixels: " + exact_text(camera.lost_pixels) +
         ", lost_frames: " + exact_text(camera.lost_frames) +
         ", time_error_ms: " + exact_text(1e3 * camera.time_error) +
         ", pitch_error_rad: " + exact_text(camera.pitch_error) + "}\n";
}

std::string plant_text(const sim::PlantSetup& plant) {
  return "plant: {robot: " + plant.robot + ", mass_scale: " + exact_text(plant.mass_scale) +
         ", inertia_scale: " + exact_text(plant.inertia_scale) +
         ", motor_strength: " + exact_text(plant.motor_strength) +
         ", latency_ms: " + std::to_string(plant.latency_ticks) +
         ", exchange_Hz: " + (plant.exchange_period == 1 ? "1000" : "500") +
         ", sensor_noise: " + exact_text(plant.sensor_noise) + "}\n";
}

std::string targets_text(const std::vector<core::TargetOverride>& targets) {
  std::string text = targets.empty() ? "" : "targets:\n";
  for (const core::TargetOverride& target : targets) {
    text += "  - {distance_m: " + exact_text(target.distance);
    if (std::isfinite(target.height)) text += ", height_m: " + exact_text(target.height);
    text += ", lateral_m: " + exact_text(target.lateral) + ", yaw_rad: " + exact_text(target.yaw) +
            "}\n";
  }
  return text;
}

std::string surprises_text(const sim::Scenario& scenario) {
  if (scenario.height_surprises.empty() && scenario.pushes.empty()) return "";
  std::string text = "surprises:\n";
  for (const sim::HeightSurprise& surprise : scenario.height_surprises) {
    text += "  - {slab: " + std::to_string(surprise.slab) +
            ", top_m: " + exact_text(surprise.rise) + "}\n";
  }
  for (const sim::Push& push : scenario.pushes) text += push_text(push);
  return text;
}

}  // namespace

std::string scenario_text(const sim::Scenario& scenario) {
  std::string text = "name: " + scenario.name + "\nrobot: " + scenario.robot +
                     "\nfriction: " + exact_text(scenario.friction) +
                     "\npit_depth_m: " + exact_text(scenario.seen.pit_depth) + "\n" +
                     camera_text(scenario.camera) + "slabs:\n";
  for (const sim::Slab& slab : scenario.seen.slabs) text += slab_text(slab);
  text += "start: {x_m: " + exact_text(scenario.start.x) +
          ", yaw_rad: " + exact_text(scenario.start.yaw) +
          ", drop_m: " + exact_text(scenario.start.drop) + "}\n";
  text += scenario.goal.jumps ? "goal: {jumps: " + std::to_string(*scenario.goal.jumps) + "}\n"
                              : "goal: {x_m: " + exact_text(scenario.goal.x.value()) + "}\n";
  return text + targets_text(scenario.targets) + surprises_text(scenario) +
         plant_text(scenario.plant);
}

}  // namespace hopscotch::apps::campaign
