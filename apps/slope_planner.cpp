#include "apps/slope_planner.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace hopscotch::apps {

// A force (r, 0, 1) on soles with the normal (-rise, -across, 1) holds while
// (1 - r rise)^2 (1 + mu^2) >= (1 + r^2) (1 + rise^2 + across^2): the largest such r.
double level_friction(double friction, double rise, double across) {
  const double cone = 1.0 + friction * friction;
  const double normal = 1.0 + rise * rise + across * across;
  if (cone <= normal) return 0.0;
  const double a = normal - cone * rise * rise;
  const double b = cone * rise;
  return (std::sqrt(b * b + a * (cone - normal)) - b) / a;
}

SlopePlanner::SlopePlanner(const planner::PlannerConfig& config,
                           const model::RobotParameters& robot,
                           std::shared_ptr<const planner::JumpLibrary> library)
    : config_(config),
      robot_(robot),
      library_(std::move(library)),
      level_(config, robot, library_) {}

double SlopePlanner::friction_for(const core::LandingTarget& target) const {
  const double from = control::beyond_scatter(control::slope_along(target.profile, 0.0));
  const control::GroundSlope to = control::slope_ahead(target);
  const double across = std::tan(control::beyond_scatter(to.across));
  // Slopes are pitches of soles: those that lie on rising ground have their toes up.
  const double share = config_.reserves.friction;
  const double push_off = level_friction(share * config_.friction, -std::tan(from), across);
  const double braking =
      level_friction(share * config_.friction, std::tan(control::beyond_scatter(to.along)), across);
  return std::min({config_.friction, push_off / share, braking / share});
}

core::Result<core::JumpPlan> SlopePlanner::plan(const planner::PlanRequest& request) {
  const double friction = friction_for(request.target);
  solved_ = false;
  if (!(friction < config_.friction)) {
    core::Result<core::JumpPlan> plan = level_.plan(request);
    solved_ = plan && request.formulation == planner::Formulation::variable &&
              level_.rung() != planner::PlanRung::library;
    return plan;
  }
  planner::PlannerConfig config = config_;
  constexpr double kLeast = 0.05;  // of a planner's friction; no plan comes of so little
  config.friction = std::max(friction, kLeast);
  return planner::JumpPlanner(config, robot_, library_).plan(request);
}

std::shared_ptr<const planner::KnownJump> SlopePlanner::solution() const {
  return solved_ ? std::make_shared<const planner::KnownJump>(*level_.last()) : nullptr;
}

}  // namespace hopscotch::apps
