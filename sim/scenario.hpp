#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/config_reader.hpp"
#include "core/jump_plan.hpp"
#include "core/operator_command.hpp"
#include "sim/camera_settings.hpp"
#include "sim/terrain.hpp"

namespace hopscotch::sim {

/// Where the robot is put: section `start`.
struct StartPlace {
  double x = 0.0;     ///< Mid-point of the soles, in W [m]; its y is 0.
  double yaw = 0.0;   ///< Of the robot in W [rad].
  double drop = 0.0;  ///< Height of the soles above the ground at release [m].
};

/// When the run is complete: section `goal`; exactly one of the two is set.
struct Goal {
  /// Both heels beyond this, along the initial heading, from the origin of W [m].
  std::optional<double> x;
  /// So many jumps landed.
  std::optional<int> jumps;
};

/// A slab whose true top differs from the one perception is shown.
struct HeightSurprise {
  std::size_t slab = 0;
  double rise = 0.0;  ///< True top minus seen top [m].
};

/// A push at the trunk's CoM. Starts `after` the beginning of the `occurrence`-th such phase, or at
/// the absolute time `at` when there is no phase.
struct Push {
  std::optional<core::JumpPhase> phase;
  int occurrence = 1;                                 ///< 1 = the first time.
  double after = 0.0;                                 ///< [s]
  double at = 0.0;                                    ///< Without phase: since the start [s].
  double duration = 0.1;                              ///< [s], whole ticks.
  Eigen::Vector3d impulse = Eigen::Vector3d::Zero();  ///< In W [N·s].
};

/// How the simulated robot differs from the model: section `plant`.
struct PlantSetup {
  std::string robot = "hector";  ///< Default: the robot of the scenario.
  double mass_scale = 1.0;       ///< On masses and inertias of all links [-].
  double inertia_scale = 1.0;    ///< On rotational inertias of all links, beside mass_scale [-].
  double motor_strength = 1.0;   ///< On torque, line and power of all motors [-].
  int latency_ticks = 2;         ///< Delay of set-points [ticks of 1 ms].
  int exchange_period = 1;       ///< Ticks between exchanges: 1 (1 kHz) or 2 (500 Hz).
  double sensor_noise = 1.0;     ///< On all noises, biases and quantisation steps; 0 is perfect.
};

/// One scenario file, checked: terrain, robot, disturbances and goal.
/// W is the scenario's frame: the controller's W is the same one when it is given the true state.
struct Scenario {
  std::string name;              ///< Of its folder of runs too, see core::read_plain_name.
  std::string robot = "hector";  ///< What the controller believes it drives.
  double friction = 0.6;         ///< Sole on ground unless a slab says otherwise [-].
  CameraSettings camera;         ///< Section `camera`.
  Terrain seen;                  ///< What perception is shown.
  StartPlace start;
  Goal goal;
  /// Where the first jumps are to land, one each; the robot chooses the others.
  std::vector<core::TargetOverride> targets;
  std::vector<HeightSurprise> height_surprises;
  std::vector<Push> pushes;
  PlantSetup plant;

  /// `seen` with the height surprises: what the robot stands on.
  [[nodiscard]] Terrain true_terrain() const;

  /// @throws core::ConfigError with file, line, key, value and the broken rule.
  static Scenario load(const std::filesystem::path& file);
  /// The same from memory; `name_of_text` stands for the file in messages.
  static Scenario from_text(std::string_view text, std::string name_of_text);
  static Scenario from_reader(const core::ConfigReader& reader);
};

/// Outline of both soles in the start posture, about their mid-point; all HECTOR variants agree
/// with it to 1 mm.
struct StanceOutline {
  static constexpr double kHalfLength = 0.075;   ///< Sole centre to toe or heel [m].
  static constexpr double kHalfSpacing = 0.098;  ///< Mid-point to a sole's centre line [m].
  static constexpr double kHalfWidth = 0.010;    ///< Of one sole [m].
};

}  // namespace hopscotch::sim
