#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "control/contact_detector.hpp"
#include "control/control_config.hpp"
#include "control/delay_estimator.hpp"
#include "control/ground_tilt.hpp"
#include "control/jump_supervisor.hpp"
#include "control/plan_follower.hpp"
#include "control/recovery_hop.hpp"
#include "control/stand_plan.hpp"
#include "control/wrench_mpc.hpp"
#include "core/control_reference.hpp"
#include "core/control_status.hpp"
#include "core/joint_command.hpp"
#include "core/jump_plan.hpp"
#include "core/robot_state.hpp"
#include "core/sensor_readings.hpp"
#include "model/robot_parameters.hpp"

namespace hopscotch::control {

/// What the MPC is asked at one moment: the state as it will be when the answer acts, and the
/// window.
struct MpcQuestion {
  core::RobotState state;
  core::ControlReference reference;
  MpcForm form = MpcForm::full;
};

/// The MPC's answer on its way back to the tick.
struct MpcAnswer {
  core::Stamp stamp;  ///< Of the state that it was computed from.
  MpcStatus status = MpcStatus::bad_input;
  MpcForm form = MpcForm::full;
  core::ContactWrenches planned{};   ///< Of the reference's first step.
  core::ContactWrenches wrenches{};  ///< Chosen for the first step.
};

/// The 1 kHz loop body: phase machine, plan look-up, torque law. Follows one plan at a time;
/// standing is the end of a plan, so that there is always one. A command takes `actuation_delay` to
/// reach the joints: set-points are looked up where the body will be by then, feedback terms where
/// it is.
///
/// Real-time: `tick`, `offer`, `question` and `answer` do not allocate, lock or throw.
class ControlTick {
 public:
  /// @param stand Where jumps start and end; the first tick goes there from where the robot is.
  ControlTick(const ControlConfig& config, const model::RobotParameters& robot,
              const StandTarget& stand);

  /// Lets the measured torques tell how late commands act, while the robot stands; until that is
  /// clear the configured delay counts. To be called before `tick`, with readings of the same
  /// stamp.
  void observe_drives(const core::SensorReadings& readings) noexcept;
  /// As known by now [s].
  [[nodiscard]] double actuation_delay() const { return config_.actuation_delay; }

  /// One millisecond. Returns the set-points of the drives.
  core::JointCommand tick(const core::RobotState& state) noexcept;

  /// Hands over the next jump; it starts when the present one has landed, at once when standing.
  void offer(const core::JumpPlan& plan) noexcept;

  /// From where on the jump under way may go on by another plan.
  struct RestPlace {
    std::size_t knot = 0;  ///< The first of the plan's that is replaced.
    double begin = 0.0;    ///< On the plan's clock [s].
  };
  struct RestQuestion {
    RestPlace place;
    core::RobotState state;  ///< That the body will probably have there.
  };
  /// Where a takeoff or, once the impact is over, a landing may be planned anew, at least `ahead`
  /// from now [s]: a takeoff, whose steps have fixed lengths, from its next knot that was not yet
  /// replaced, a landing from any moment. Null in other phases, and where no such knot is left.
  [[nodiscard]] std::optional<RestQuestion> rest_question(double ahead) const noexcept;
  /// Goes on by another plan of the same jump.
  /// @param rest Its clock starts at `place.begin`.
  /// @return false, and changes nothing, if that moment has passed or `rest` is not of this jump.
  bool replace_rest(const core::JumpPlan& rest, const RestPlace& place) noexcept;

  /// The operator's wishes, after the phase table of JumpSupervisor; false = refused in this phase.
  /// Holding drops the next jump, calls off one that is not past its commit point, and otherwise
  /// waits for the landing. @pre tick() has run.
  [[nodiscard]] bool hold() noexcept;
  /// Jumps may begin again; a limp robot that is upright gets up.
  [[nodiscard]] bool release() noexcept;
  [[nodiscard]] bool damp() noexcept;
  /// A cleared fault leaves the robot limp; `release` is what makes it stand.
  [[nodiscard]] bool clear_fault() noexcept;

  /// True in the phases in which the feet bear load: the MPC has something to choose.
  [[nodiscard]] bool wants_wrenches() const {
    return phase() != core::RobotPhase::flight && !core::is_limp(phase());
  }
  /// True in the tick that began a phase: the last answer belongs to another one, solve at once.
  [[nodiscard]] bool phase_changed() const { return phase_changed_; }
  /// What the feet should be doing at the next tick: for the state estimator.
  [[nodiscard]] ContactExpectation expected_contact() const noexcept;
  /// How the robot will stand when the present plan has ended: its last posture on the feet's
  /// present places, at rest. The next jump is planned from here.
  [[nodiscard]] core::RobotState rest_state() const noexcept;
  /// Fills the question for the state of the last tick; `reference.horizon` is an input.
  void question(MpcQuestion& out) const noexcept;
  /// A failed solve changes nothing: the last good answer counts for as long as it is fresh, then
  /// the plan's own wrenches with stiffer joints.
  void answer(const MpcAnswer& answer) noexcept;

  [[nodiscard]] core::RobotPhase phase() const { return supervisor_.phase(); }
  [[nodiscard]] bool has_next() const { return has_next_; }
  [[nodiscard]] const core::JumpPlan& plan() const { return plan_; }
  [[nodiscard]] const core::ControlStatus& status() const { return status_; }
  /// Ticks in which a load-bearing phase had no fresh answer of the MPC.
  [[nodiscard]] std::uint64_t stale_ticks() const { return stale_ticks_; }
  void latch(core::Reason fault) noexcept { supervisor_.latch(fault); }

 private:
  [[nodiscard]] double command_time(core::Stamp now) const noexcept;
  [[nodiscard]] bool may_go_on_otherwise() const noexcept;
  [[nodiscard]] std::optional<RestPlace> rest_place(double begin) const noexcept;
  void begin_next(const core::RobotState& state) noexcept;
  void settle(const core::RobotState& state, double duration) noexcept;
  void settle_again(const core::RobotState& state) noexcept;
  void hop_if_it_must(const core::RobotState& state) noexcept;
  [[nodiscard]] double catch_time(const core::RobotState& state) const noexcept;
  [[nodiscard]] core::JointCommand next_command(const core::RobotState& state) noexcept;
  void enter_phase(const core::RobotState& state) noexcept;
  void follow_feet(const core::RobotState& state) noexcept;
  void set_joint_targets(const core::RobotState& state, core::JointCommand& command) const noexcept;
  void set_feed_forward(const core::RobotState& state, core::JointCommand& command) noexcept;
  void push_off(const core::RobotState& state, const core::JumpKnot& planned,
                core::JointCommand& command) noexcept;
  void bear_load(const core::RobotState& state, const core::JumpKnot& planned,
                 core::JointCommand& command) noexcept;
  void bear_wrenches(const core::RobotState& state, const core::JointVector& base,
                     core::JointCommand& command) noexcept;
  [[nodiscard]] double joint_scale() const noexcept;
  [[nodiscard]] double stray(const core::RobotState& state, double body_time) const noexcept;
  [[nodiscard]] MpcForm takeoff_form() const noexcept;
  [[nodiscard]] bool answer_is_fresh() const noexcept;

  /// From touchdown until the feet have lost their speed [s].
  static constexpr double kImpactTime = 0.015;

  ControlConfig config_;
  model::RobotParameters robot_;
  JumpSupervisor supervisor_;
  StandTarget stand_;
  core::JumpPlan plan_;
  core::JumpPlan next_;
  core::JumpPlan hop_plan_;  ///< Being made.
  bool has_next_ = false;
  core::Stamp start_;              ///< Of the plan's clock, as commands see it.
  std::size_t replaced_knot_ = 0;  ///< The plan was planned anew from here on.
  core::Stamp replaced_;           ///< The last time that this was done.
  bool started_ = false;
  core::RobotPhase last_phase_ = core::RobotPhase::stand;  ///< At the end of the last tick.
  bool phase_changed_ = false;
  core::Stamp touchdown_;
  PlanPlacement placement_;
  GroundTilt tilt_;
  bool is_falling_ = false;      ///< In flight without a jump.
  bool impact_pending_ = false;  ///< Of the end of a fall.
  bool shape_pending_ = false;   ///< Of a landing that was not as planned.
  bool was_hopping_ = false;     ///< At the end of the last tick.
  DelayEstimator delays_;
  core::RobotState state_;
  MpcAnswer answer_;
  core::ControlStatus status_;
  std::uint64_t stale_ticks_ = 0;
  double unanswered_for_ = 0.0;  ///< Load has been borne without a fresh answer for so long [s].
};

}  // namespace hopscotch::control
