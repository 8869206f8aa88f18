#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "apps/jump_scorer.hpp"
#include "apps/pipeline.hpp"
#include "apps/program_config.hpp"
#include "apps/run_result.hpp"
#include "core/ablation.hpp"
#include "core/sensor_readings.hpp"
#include "sim/mujoco_plant.hpp"
#include "sim/scenario.hpp"
#include "sim/sim_camera.hpp"

namespace hopscotch::apps {

enum class Eyes : std::uint8_t { camera, truth };
enum class StateSource : std::uint8_t { estimate, truth };

/// One simulated run, as asked for.
struct RunRequest {
  sim::Scenario scenario;
  ProgramConfig config;
  model::RobotParameters robot;        ///< As the controller believes it.
  model::RobotParameters plant_robot;  ///< As simulated, before `scenario.plant`'s scales.
  std::uint64_t seed = 1;
  int jumps_max = 0;  ///< Stop after so many; 0: no limit.
  Eyes eyes = Eyes::camera;
  StateSource state = StateSource::estimate;
  core::Ablation ablation = core::Ablation::none;
  Threading threading = Threading::lockstep;
  bool log_depth = false;  ///< Record what perception was given, so that it can be replayed.
};

/// Everything that happened in one tick, for logs and views.
struct TickRecord {
  const core::SensorReadings& readings;
  const core::RobotState& state;  ///< As the controller was given it.
  const core::JointCommand& command;
  const sim::PlantTruth& truth;
  const core::ControlStatus& status;
  const PipelineEvents& events;
  const core::JumpPlan& plan;  ///< Being executed.
  int jump = 0;                ///< Number of the present jump, from 1; 0 before the first.
  bool held = false;           ///< By the operator.
};

/// The simulated camera with its drawing done on a thread of its own.
class DrawnElsewhere final : public core::DepthSource {
 public:
  /// @param camera Outlives this object.
  explicit DrawnElsewhere(sim::SimCamera& camera);
  std::optional<core::DepthFrame> poll(core::Stamp now) override;

 private:
  sim::SimCamera& camera_;
  Stage<sim::SimCamera::Exposure, core::DepthFrame> drawing_;
};

/// Robot brain and simulated world, one millisecond at a time: in lock-step, or with the brain's
/// stages on their threads, which the caller then has to pace at real time.
class LockstepRun {
 public:
  /// @throws core::ConfigError if the robot cannot stand as configured.
  explicit LockstepRun(const RunRequest& request);

  /// One tick; `observe` sees it before the verdict. False once the run has ended.
  bool step(const std::function<void(const TickRecord&)>& observe);

  /// A wish of the operator; its answer is among the events of a later tick. @pre step() has run.
  void apply(const core::OperatorCommand& command) { pipeline_.apply(command); }

  [[nodiscard]] std::optional<DecisionView> decision_view() const {
    return pipeline_.decision_view();
  }

  /// Ends the run where it stands, e.g. at the user's wish.
  void stop();

  /// What came of it; complete once `step` has returned false. Identity and timing are the
  /// caller's.
  [[nodiscard]] RunResult result() const;

  [[nodiscard]] core::Stamp now() const { return plant_.now(); }
  /// Wall times of the stages so far [ms].
  struct StageSamples {
    std::vector<double> plan_ms, replan_ms, mpc_ms, perception_ms, estimator_ms, tick_ms;
    std::size_t allocations = 0;  ///< In estimator and control tick.
  };
  [[nodiscard]] const Pipeline& pipeline() const { return pipeline_; }
  [[nodiscard]] const StageSamples& samples() const { return samples_; }

 private:
  [[nodiscard]] Pipeline::TerrainOracle oracle() const;
  void collect_times();
  void compare(const sim::PlantTruth& truth);
  void judge(const sim::PlantTruth& truth);
  void end(RunOutcome outcome, const core::Refusal& reason, const sim::PlantTruth& truth);

  RunRequest request_;
  sim::MujocoPlant plant_;
  sim::SimCamera camera_;
  std::optional<DrawnElsewhere> drawn_elsewhere_;  ///< With threads.
  Pipeline pipeline_;
  JumpScorer scorer_;
  core::JointCommand command_;
  core::RobotState true_state_;
  std::optional<core::Stamp> fault_since_;
  bool ended_ = false;
  RunResult result_;
  StageSamples samples_;
};

}  // namespace hopscotch::apps
