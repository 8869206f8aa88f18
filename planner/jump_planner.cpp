#include "planner/jump_planner.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "planner/certificate.hpp"
#include "planner/certified_plan.hpp"
#include "planner/corrected_ipopt.hpp"
#include "planner/jump_library.hpp"
#include "planner/landing_phase.hpp"
#include "planner/lift_to_3d.hpp"
#include "planner/planar_task.hpp"
#include "planner/warm_start.hpp"

namespace hopscotch::planner {

namespace {

using core::Reason;
using core::Refusal;

// A jump of the library as it is. The terrain's smoothness allows as much in height.
constexpr double kShiftMax = 0.03;         // of the landing, forward or back [m]
constexpr double kHeightMismatch = 0.010;  // [m]
constexpr double kStartPitch = 0.04;       // of each link [rad]
constexpr double kStartRate = 0.30;        // [rad/s]

/// Jumps of the library that a solve is started from before it is given up.
constexpr std::size_t kNeighbours = 2;

/// Of all rungs together: what the solves of one plan may take, so that its time has a bound
/// (docs/decisions/0076). The library's jumps as they are cost next to nothing.
constexpr int kIterationsInAll = 170;

/// A solve from a neighbour that ends no further from feasible goes on once from where it is: at
/// the rim, an edge that lies one sample nearer takes it twice the usual iterations.
constexpr double kCloseViolation = 0.02;

/// In the words of the certificate.
constexpr const char* kShankLimit = "shank clearance";

/// A jump to the side or with a turn loads one leg more, slides it sideways and reaches further
/// with it: it uses so much less of each reserve, and the certificate judges each leg.
constexpr double kSideShare = 0.94;

PlannerConfig with_room_for_one_leg(PlannerConfig config) {
  for (double* share : {&config.reserves.torque, &config.reserves.speed, &config.reserves.friction,
                        &config.reserves.power}) {
    *share *= kSideShare;
  }
  return config;
}

/// The final stand is not a variable: where it is not clear of the ground no motion helps.
std::optional<Refusal> blocked_stand(const PlanarModel& model, const PlanarTask& task) {
  const double leant = task.final_posture[model::kShank];
  const double lower = landed_shank_range(model, task).lower;
  if (leant >= lower) return std::nullopt;
  char text[200];
  std::snprintf(text, sizeof text,
                "standing at %.3f m, height %.3f m, the shanks lean back by %.2f rad, but the "
                "ground behind leaves room for %.2f rad; stopped by %s",
                task.distance, task.height, -leant, -lower, kShankLimit);
  return Refusal{Reason::plan_infeasible, text};
}

core::JumpPlan plan_for(const PlanRequest& request, const SolveOutcome& outcome) {
  core::JumpPlan plan;
  plan.id = request.id;
  plan.stamp = request.start.stamp;
  plan.target = request.target;
  plan.status = outcome.status == SolveStatus::solved ? core::PlanStatus::solved
                                                      : core::PlanStatus::iteration_limit;
  plan.iterations = outcome.iterations;
  return plan;
}

bool is_close(const SolveOutcome& outcome) {
  return outcome.status == SolveStatus::iteration_limit && !is_acceptable(outcome) &&
         outcome.violation <= kCloseViolation;
}

/// Of a rung below the first; what is reported is the refusal of the first.
Refusal no_plan() {
  return {Reason::plan_infeasible, "nothing at hand leads there"};
}

/// One request, projected.
struct Trial {
  const PlanarModel& model;
  const PlanarTask& task;
  const PlanRequest& request;
};

/// May the motion of a library's jump be flown as it is?
bool is_at_hand(const KnownJump& jump, const PlanarTask& task, double shift_max) {
  for (std::size_t j = 0; j < model::kPlanarLinks; ++j) {
    if (std::abs(jump.start.pitch[j] - task.start.pitch[j]) > kStartPitch ||
        std::abs(jump.start.rate[j] - task.start.rate[j]) > kStartRate) {
      return false;
    }
  }
  return std::abs(jump.height - task.height) <= kHeightMismatch &&
         std::abs(jump.distance - task.distance) <= shift_max;
}

/// The request with its landing moved along the jump line.
PlanRequest moved_to(PlanRequest request, double distance) {
  core::LandingTarget& target = request.target;
  const Eigen::Vector3d ahead(std::cos(target.heading), std::sin(target.heading), 0.0);
  for (Eigen::Isometry3d& X_WF : target.X_WF) {
    X_WF.pretranslate((distance - target.distance) * ahead);
  }
  target.distance = distance;
  return request;
}

}  // namespace

struct JumpPlanner::Memory {
  PlanarModel straight;  ///< For jumps ahead.
  PlanarModel sideways;  ///< For the others: what one leg may use more than the other is kept.
  DecisionLayout layout;
  CorrectedSolver chain;
  std::shared_ptr<const JumpLibrary> library;
  std::optional<KnownJump> last;  ///< Solved by `chain` and certified.
  Eigen::VectorXd last_by_ipopt;  ///< The same by Ipopt; empty before the first.
  std::string_view obstacle;      ///< Limit that the last refusal is about.
  int iterations = 0;             ///< Of the last plan, all rungs.
  double cost = 0.0;              ///< Of the last certified solution.
  PlanRung rung = PlanRung::solved;

  Memory(const model::RobotParameters& robot, const PlannerConfig& config,
         std::shared_ptr<const JumpLibrary> jumps)
      : straight(robot, config),
        sideways(robot, with_room_for_one_leg(config)),
        layout(config.steps),
        chain(layout),
        library(jumps ? std::move(jumps) : std::make_shared<const JumpLibrary>()) {}

  [[nodiscard]] core::Result<core::JumpPlan> plan_by_ipopt(const Trial& trial);
  [[nodiscard]] core::Result<core::JumpPlan> climb_down(const Trial& trial);
  /// Prepares one more solve; false when the plan has had its share of iterations.
  [[nodiscard]] bool has_time();
  [[nodiscard]] core::Result<core::JumpPlan> by_neighbours(const Trial& trial, std::size_t from,
                                                           std::size_t to);
  [[nodiscard]] core::Result<core::JumpPlan> by_library(const Trial& trial);
  [[nodiscard]] core::Result<core::JumpPlan> finish(const Trial& trial, const SolvedMotion& solved);
  [[nodiscard]] core::Result<core::JumpPlan> finish_near(const Trial& trial, const KnownJump& from);
  [[nodiscard]] core::Result<core::JumpPlan> plan_otherwise(const PlanRequest& request,
                                                            const PlanarTask& task);
};

core::Result<core::JumpPlan> JumpPlanner::Memory::plan_by_ipopt(const Trial& trial) {
  const auto& [model, task, request] = trial;
  const bool warm = request.guess == StartGuess::previous && last_by_ipopt.size() > 0;
  const SolvedMotion solved = solve_corrected_with_ipopt(
      model, task, layout, warm ? last_by_ipopt : kinematic_guess(model, task, layout));
  core::Result<core::JumpPlan> plan = finish(trial, solved);
  if (!plan) return plan;
  plan.value().warm = warm;
  last_by_ipopt = solved.outcome.x;
  return plan;
}

/// A solved motion as a plan, or why it is none.
core::Result<core::JumpPlan> JumpPlanner::Memory::finish(const Trial& trial,
                                                         const SolvedMotion& solved) {
  const auto& [model, task, request] = trial;
  const SolveOutcome& outcome = solved.outcome;
  iterations += outcome.iterations;
  const bool by_chain = request.solver == Solver::chain;
  obstacle = by_chain ? chain.obstacle() : std::string_view{};
  if (!is_acceptable(outcome)) return infeasible(outcome, task, obstacle);
  core::JumpPlan plan = plan_for(request, outcome);
  if (std::optional<Refusal> refusal = certify_and_lift(model, task, solved, plan)) {
    obstacle = plan.certificate.binding().name;
    return *refusal;
  }
  if (by_chain) last = chain.known(task, solved);
  cost = outcome.cost;
  plan.iterations = iterations;
  return plan;
}

core::Result<core::JumpPlan> JumpPlanner::Memory::finish_near(const Trial& trial,
                                                              const KnownJump& from) {
  SolvedMotion solved = chain.solve_near(trial.model, trial.task, from);
  if (is_close(solved.outcome)) {
    iterations += std::exchange(solved.outcome.iterations, 0);
    const KnownJump here = chain.known(trial.task, solved);
    if (has_time()) solved = chain.solve_near(trial.model, trial.task, here);
  }
  core::Result<core::JumpPlan> plan = finish(trial, solved);
  if (plan) plan.value().warm = true;
  return plan;
}

bool JumpPlanner::Memory::has_time() {
  const int left = kIterationsInAll - iterations;
  if (left > 0) chain.allow(left);
  return left > 0;
}

/// The ladder: the first rung that gives a certified plan.
core::Result<core::JumpPlan> JumpPlanner::Memory::climb_down(const Trial& trial) {
  core::Result<core::JumpPlan> first = no_plan();
  if (trial.request.guess == StartGuess::previous && last && has_time()) {
    const KnownJump from = *last;
    first = finish_near(trial, from);
    if (first) return first;
  }
  const std::size_t tried = trial.request.guess == StartGuess::kinematic ? 0 : 1;
  if (tried > 0) {
    if (core::Result<core::JumpPlan> plan = by_neighbours(trial, 0, tried)) return plan;
    rung = PlanRung::solved;
  }
  const auto& [model, task, request] = trial;
  if (has_time()) {
    first = finish(trial, chain.solve(model, task, kinematic_guess(model, task, layout)));
  }
  if (first) return first;
  const std::string_view first_obstacle = obstacle;
  if (core::Result<core::JumpPlan> plan = by_neighbours(trial, tried, kNeighbours)) return plan;
  if (core::Result<core::JumpPlan> plan = by_library(trial)) return plan;
  obstacle = first_obstacle;
  return first;
}

core::Result<core::JumpPlan> JumpPlanner::Memory::by_neighbours(const Trial& trial,
                                                                std::size_t from, std::size_t to) {
  rung = PlanRung::neighbour;
  const std::vector<const KnownJump*> near = library->nearest(trial.task, to);
  for (std::size_t i = from; i < near.size() && has_time(); ++i) {
    if (core::Result<core::JumpPlan> plan = finish_near(trial, *near[i])) return plan;
  }
  return no_plan();
}

/// A jump as the library has it, to its own distance, where the ground bears that.
core::Result<core::JumpPlan> JumpPlanner::Memory::by_library(const Trial& trial) {
  rung = PlanRung::library;
  const core::LandingTarget& wanted = trial.request.target;
  if (!side_target(wanted).is_straight()) return no_plan();
  const double shift =
      std::isfinite(wanted.margin) ? std::clamp(wanted.margin, 0.0, kShiftMax) : kShiftMax;
  for (const KnownJump* jump : library->nearest(trial.task, library->jumps().size())) {
    if (!is_at_hand(*jump, trial.task, shift)) continue;
    const PlanRequest request = moved_to(trial.request, jump->distance);
    const core::Result<PlanarTask> task = planar_task(trial.model, request);
    if (!task) continue;
    SolvedMotion motion;
    motion.outcome.status = SolveStatus::solved;
    motion.motion = motion_of(*jump, trial.model, *task, layout);
    core::JumpPlan plan = plan_for(request, motion.outcome);
    if (certify_and_lift(trial.model, *task, motion, plan)) continue;
    plan.iterations = iterations;
    plan.warm = true;
    return plan;
  }
  return no_plan();
}

/// By a formulation that is compared with the planner's own.
core::Result<core::JumpPlan> JumpPlanner::Memory::plan_otherwise(const PlanRequest& request,
                                                                 const PlanarTask& task) {
  if (!side_target(request.target).is_straight()) {
    return Refusal{Reason::target_malformed, "this formulation plans jumps straight ahead only"};
  }
  const FormulatedJump solved = solve_formulation(request.formulation, straight, task);
  iterations = solved.outcome.iterations;
  if (solved.outcome.status != SolveStatus::solved) return infeasible(solved.outcome, task, {});
  core::JumpPlan plan = plan_for(request, solved.outcome);
  const CertifiedMotion certified = certify(straight, task, solved.motion);
  plan.certificate = certified.certificate;
  plan.certificate.max_violation = solved.outcome.violation;
  plan.peaks = certified.peaks;
  if (!lift_to_3d(straight, solved.motion, plan.target, plan)) {
    return Refusal{Reason::out_of_reach, "a leg cannot reach so far"};
  }
  return plan;
}

std::string_view plan_rung_name(PlanRung rung) {
  switch (rung) {
    case PlanRung::solved: return "solved";
    case PlanRung::neighbour: return "neighbour";
    case PlanRung::library: return "library";
  }
  return "";
}

JumpPlanner::JumpPlanner(const PlannerConfig& config, const model::RobotParameters& robot,
                         std::shared_ptr<const JumpLibrary> library)
    : memory_(std::make_unique<Memory>(robot, config, std::move(library))) {
  const StepCounts& steps = config.steps;
  const int knots = steps.takeoff + steps.flight + steps.landing + 1;
  if (knots > static_cast<int>(core::JumpPlan::kMaxKnots)) {
    throw std::invalid_argument("planner.steps: together at most " +
                                std::to_string(core::JumpPlan::kMaxKnots - 1));
  }
  if (!memory_->library->fits(steps)) {
    throw std::invalid_argument("planner.steps: the library of jumps has others");
  }
}

std::string_view JumpPlanner::obstacle() const {
  return memory_->obstacle;
}

int JumpPlanner::iterations() const {
  return memory_->iterations;
}

PlanRung JumpPlanner::rung() const {
  return memory_->rung;
}

double JumpPlanner::cost() const {
  return memory_->cost;
}

const KnownJump* JumpPlanner::last() const {
  return memory_->last ? &*memory_->last : nullptr;
}

JumpPlanner::~JumpPlanner() = default;
JumpPlanner::JumpPlanner(JumpPlanner&&) noexcept = default;
JumpPlanner& JumpPlanner::operator=(JumpPlanner&&) noexcept = default;

core::Result<core::JumpPlan> JumpPlanner::plan(const PlanRequest& request) {
  const bool straight = side_target(request.target).is_straight();
  const PlanarModel& model = straight ? memory_->straight : memory_->sideways;
  memory_->obstacle = {};
  memory_->iterations = 0;
  memory_->rung = PlanRung::solved;
  const core::Result<PlanarTask> task = planar_task(model, request);
  if (!task) return task.error();
  if (request.formulation != Formulation::variable) return memory_->plan_otherwise(request, *task);
  if (std::optional<Refusal> refusal = blocked_stand(model, *task)) {
    memory_->obstacle = kShankLimit;
    return *refusal;
  }

  const Trial trial{model, *task, request};
  return request.solver == Solver::ipopt ? memory_->plan_by_ipopt(trial)
                                         : memory_->climb_down(trial);
}

}  // namespace hopscotch::planner
