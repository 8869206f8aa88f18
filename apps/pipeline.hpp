#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "apps/operator_desk.hpp"
#include "apps/program_config.hpp"
#include "apps/slope_planner.hpp"
#include "apps/stage.hpp"
#include "apps/state_history.hpp"
#include "control/control_tick.hpp"
#include "control/state_estimator.hpp"
#include "control/wrench_mpc.hpp"
#include "core/depth_source.hpp"
#include "core/joint_command.hpp"
#include "core/jump_plan.hpp"
#include "core/landing_target.hpp"
#include "core/one_step_terrain.hpp"
#include "core/operator_command.hpp"
#include "core/result.hpp"
#include "core/robot_state.hpp"
#include "core/sensor_readings.hpp"
#include "footstep/height_doubt.hpp"
#include "footstep/landing_selector.hpp"
#include "model/robot_parameters.hpp"
#include "perception/occupancy.hpp"
#include "perception/terrain_mapper.hpp"
#include "planner/replanner.hpp"

namespace hopscotch::apps {

/// What the robot is to achieve; it stops by itself when either is reached.
struct Mission {
  double goal_x = core::kNaN;  ///< Both heels beyond, along x of W [m]; NaN: no such goal.
  int jumps = 0;               ///< So many jumps; 0: no limit.
  std::vector<core::TargetOverride> targets;  ///< Of the first jumps, one each.
  control::StartPlace start;                  ///< Where the robot is put down: places W.
};

/// Why the robot jumps no more.
enum class MissionEnd : std::uint8_t { reached, refused, fault, stopped };

struct SightQuestion;
struct DecisionQuestion;

/// What the stages produced in one tick, for logs; empty where nothing was due.
struct PipelineEvents {
  /// What the estimator took in besides the readings: its start in the first tick, and what the
  /// controller expected of the feet; empty when it did not run.
  std::optional<control::StartPlace> put_down;
  std::optional<control::ContactExpectation> expected;
  std::optional<double> map_height;             ///< Told to the estimator after this tick [m].
  std::optional<core::RobotState> anchor;       ///< The map was tied to the soles of this state.
  const SightQuestion* seen = nullptr;          ///< Went to perception; valid until the next tick.
  const DecisionQuestion* asked = nullptr;      ///< Went to planning; valid until the next tick.
  std::shared_ptr<const core::TerrainMap> map;  ///< That was decided on.
  std::optional<core::OneStepTerrain> terrain;
  std::optional<core::TargetChoice> choice;
  std::optional<core::Result<core::JumpPlan>> plan;
  bool replanned = false;                     ///< The jump goes on by a new plan of its rest.
  std::vector<core::OperatorAnswer> answers;  ///< To commands of the operator.
  std::optional<double> perception_ms;        ///< Wall time of the stage in this tick.
  std::optional<double> planning_ms;
  std::optional<double> replanning_ms;
  std::optional<double> mpc_ms;
  std::optional<double> estimator_ms;
  double tick_ms = 0.0;
  std::size_t allocations = 0;  ///< By estimator and control tick: none is right.
};

/// Bottoms of what hangs over the ground, in W [m].
using HangingThings = std::shared_ptr<const std::vector<Eigen::Vector3f>>;

/// What a decision about the next jump is made from.
struct DecisionView {
  core::TerrainMap map;
  HangingThings hanging;
  core::OneStepTerrain terrain;  ///< Along the jump line of `rest`.
  core::RobotState rest;         ///< How the robot will stand.
};

/// Where the expensive stages run.
enum class Threading : std::uint8_t {
  lockstep,  ///< All on the calling thread; repeats to the bit.
  threads,   ///< Perception, planning and MPC on threads of their own, by the clock.
};

/// A depth frame and where the robot was when it was taken.
struct SightQuestion {
  core::DepthFrame frame;
  core::RobotState at_exposure;
};

struct Sight {
  core::Stamp exposed;
  perception::MapStatus status = perception::MapStatus::blind;
  std::shared_ptr<const core::TerrainMap> map;  ///< With the frame in it.
  HangingThings hanging;
};

/// From where and over what to jump next.
/// Draws what an oracle knew when it was asked, on any thread.
using MapDrawing = std::function<core::TerrainMap()>;

struct DecisionQuestion {
  std::shared_ptr<const core::TerrainMap> map;
  HangingThings hanging;
  core::RobotState rest;  ///< How the robot will stand.
  footstep::LandingTask task;
  bool for_operator = false;  ///< `task.target` is the operator's.
  std::uint64_t plan_id = 0;
  MapDrawing draw_map;  ///< An oracle's; empty: `map` is there.
};

struct Decision {
  std::shared_ptr<const core::TerrainMap> map;  ///< That was decided on.
  core::OneStepTerrain terrain;
  core::TargetChoice choice;
  std::optional<core::Result<core::JumpPlan>> plan;  ///< Empty without a target.
  /// The plan's solution, which its rest may be planned anew from; null if it has none.
  std::shared_ptr<const planner::KnownJump> solution;
};

/// What is left of the jump that is under way, planned anew; empty before the first.
using Rest = std::optional<core::Result<core::JumpPlan>>;

/// A plan and the solution that it comes from.
struct SolvedJump {
  std::uint64_t plan_id = 0;
  std::shared_ptr<const planner::KnownJump> solution;  ///< Null if it has none.
};

struct BalanceQuestion {
  core::Stamp now;
  control::MpcQuestion mpc;
};

/// The whole robot brain, stage after stage: a stage runs when its input is there, and its result
/// counts from its declared latency on.
class Pipeline {
 public:
  /// Knows the terrain without looking, for `--perception truth`. Asked in a tick, from a state.
  using TerrainOracle = std::function<MapDrawing(const core::RobotState&)>;

  /// @param oracle Empty: the depth camera is all there is.
  Pipeline(const ProgramConfig& config, const model::RobotParameters& robot, const Mission& mission,
           TerrainOracle oracle, Threading threading);

  /// One exchange: sensor readings and camera in, joint commands out. Readings with an old stamp
  /// change nothing.
  core::JointCommand tick(const core::SensorReadings& measured, core::DepthSource& camera);
  /// The same on a state known from elsewhere, for `--state truth`.
  core::JointCommand tick(const core::RobotState& state, core::DepthSource& camera);

  /// A wish of the operator, between ticks. The answer is among the events of a later tick: of the
  /// next one, or for a landing target once it has been planned. @pre tick() has run.
  void apply(const core::OperatorCommand& command);
  [[nodiscard]] bool held() const { return desk_.mode() != OperatorDesk::Mode::free; }

  /// Takes back the end by a refusal: the ground may look better later. @pre end() == refused
  void reopen();

  /// What a decision could be made from now; nothing while the robot is in the air or limp.
  [[nodiscard]] std::optional<DecisionView> decision_view() const;

  /// Set once the robot stands and will not jump again.
  [[nodiscard]] std::optional<MissionEnd> end() const { return end_; }
  [[nodiscard]] const core::Refusal& end_reason() const { return end_reason_; }
  /// @pre tick() has run.
  [[nodiscard]] const core::ControlStatus& status() const { return control_->status(); }
  [[nodiscard]] const core::JumpPlan& plan() const { return control_->plan(); }
  /// The last phase before a fault, the present one without.
  [[nodiscard]] core::RobotPhase last_active_phase() const { return last_phase_; }
  [[nodiscard]] const PipelineEvents& events() const { return events_; }
  /// The state that the last tick worked on.
  [[nodiscard]] const core::RobotState& state() const { return state_; }
  [[nodiscard]] const control::StateEstimator& estimator() const { return estimator_; }
  /// In lock-step only: with threads it may be at work.
  [[nodiscard]] const control::WrenchMpc& mpc() const { return mpc_; }
  /// Results that came later than their stage's declared latency; none in lock-step.
  [[nodiscard]] std::uint64_t late_results() const {
    return sight_.late() + decision_.late() + rest_.late() + balance_.late();
  }

 private:
  void run_stages(core::DepthSource& camera);
  void compare_height(const core::RobotState& state);
  void look(core::Stamp now, core::DepthSource& camera);
  void decide(const core::RobotState& state);
  void replan(core::Stamp now);
  void balance(core::Stamp now);
  void start(const core::RobotState& state);
  void receive_plan(const Decision& decision);
  void plan_jump(const planner::PlanRequest& request, Decision& decision);
  void count_called_off(std::uint64_t plan_id);
  void watch_mission(const core::RobotState& state);
  void ask_where(const core::RobotState& state);
  void make_decision(const DecisionQuestion& question, Decision& decision);
  void weigh(core::Stamp now, const Decision& decision);
  [[nodiscard]] bool is_idle(const core::RobotState& state) const;
  [[nodiscard]] bool may_decide(const core::RobotState& state) const;
  [[nodiscard]] bool is_blind(core::Stamp now) const;
  [[nodiscard]] bool mission_accomplished(const core::RobotState& state) const;
  void refuse(core::Stamp now, const core::Refusal& refusal);
  void apply_target(const core::OperatorCommand& command);
  void apply_mode(const core::OperatorCommand& command);
  void enable(const core::OperatorCommand& command);
  void clear_fault(const core::OperatorCommand& command);
  void next_best(const core::Refusal& refusal);
  [[nodiscard]] bool is_locked() const;
  void refuse_if_locked();

  ProgramConfig config_;
  model::RobotParameters robot_;
  Mission mission_;
  TerrainOracle oracle_;

  control::StateEstimator estimator_;
  core::RobotState state_;
  core::JointCommand command_;
  StateHistory history_;
  perception::TerrainMapper mapper_;
  perception::OccupancyMemory volume_;
  footstep::HeightDoubt doubt_;
  footstep::LandingSelector selector_;
  SlopePlanner planner_;
  planner::Replanner replanner_;
  control::WrenchMpc mpc_;
  std::optional<control::ControlTick> control_;  // starts with the first state

  std::shared_ptr<const core::TerrainMap> map_;  ///< The newest that counts.
  HangingThings hanging_ = std::make_shared<const std::vector<Eigen::Vector3f>>();

  core::Stamp last_mpc_;
  bool mpc_urgent_ = false;     ///< A phase began after the last question.
  bool height_checked_ = true;  ///< Since the last touchdown.
  bool calmed_down_ = false;    ///< The last landing, in this tick.
  core::Stamp landed_;          ///< Of the last touchdown, or of the start.
  core::Stamp still_since_;     ///< Standing still since then.
  std::optional<core::Stamp> refused_since_;
  footstep::LandingTask task_;
  OperatorDesk desk_;
  bool for_operator_ = false;  ///< The plan that is being made answers the operator's target.
  bool is_next_best_ = false;  ///< It is for a place of an earlier choice.
  core::TargetChoice choice_;  ///< The target being planned, with the ranked places it was among.
  std::vector<double> failed_distances_;  ///< Of places that could not be planned from here [m].
  core::RobotPhase last_phase_ = core::RobotPhase::stand;
  core::Stamp last_seen_;  // exposure of the newest frame in the map, or the touchdown after it
  int frames_since_landing_ = 0;
  int jumps_done_ = 0;
  int called_off_ = 0;  ///< Jumps in a row that strayed before they rose.
  std::uint64_t plans_made_ = 0;
  control::ControlTick::RestPlace rest_place_;  ///< Of the question that `rest_` works on.
  SolvedJump under_way_;
  SolvedJump planned_;  ///< The last one that was.
  std::optional<MissionEnd> end_;
  core::Refusal end_reason_;
  PipelineEvents events_;

  // Last: their threads use the stages above.
  Stage<SightQuestion, Sight> sight_;
  Stage<DecisionQuestion, Decision> decision_;
  Stage<planner::RestRequest, Rest> rest_;
  Stage<BalanceQuestion, control::MpcAnswer> balance_;
};

}  // namespace hopscotch::apps
