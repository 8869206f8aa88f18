#include "apps/proposal_desk.hpp"

#include <chrono>
#include <cmath>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <utility>

#include "apps/shipped_jumps.hpp"
#include "apps/stopwatch.hpp"

namespace hopscotch::apps {

using Json = nlohmann::ordered_json;

namespace {

constexpr auto kPatience = std::chrono::seconds(4);  // for the robot to come down

Json number(double value) {
  return std::isfinite(value) ? Json(std::round(value * 1e4) / 1e4) : Json();
}

double member(const Json& json, const char* name, double otherwise) {
  const auto found = json.find(name);
  if (found == json.end()) return otherwise;
  if (!found->is_number()) throw std::invalid_argument(std::string(name) + " must be a number");
  return found->get<double>();
}

struct Place {
  double x = core::kNaN;  ///< In W [m].
  double y = core::kNaN;
  double yaw = 0.0;  ///< Of the feet in S [rad].
};

Place place_of(const std::string& request) {
  const Json json = Json::parse(request, nullptr, false);
  if (!json.is_object()) throw std::invalid_argument("not a JSON object");
  const Place place{member(json, "x", core::kNaN), member(json, "y", core::kNaN),
                    member(json, "yaw", 0.0)};
  const bool finite = std::isfinite(place.x) && std::isfinite(place.y) && std::isfinite(place.yaw);
  if (!finite) throw std::invalid_argument("x and y must be given");
  return place;
}

core::TargetOverride target_at(const Place& place, const core::OneStepTerrain& terrain) {
  const Eigen::Vector2d offset = Eigen::Vector2d(place.x, place.y) - terrain.p_WS.head<2>();
  const Eigen::Rotation2Dd R_SW(-terrain.heading);
  const Eigen::Vector2d p_S = R_SW * offset;
  // What a person means by a click near the jump line is a place on it.
  constexpr double kOnLine = 0.06;  // [m]
  const double lateral = std::abs(p_S.y()) < kOnLine ? 0.0 : p_S.y();
  return {.distance = p_S.x(), .lateral = lateral, .yaw = place.yaw};
}

Json plan_of(const core::JumpPlan& plan) {
  Json json = {{"duration", number(plan.duration)},
               {"flight", number(plan.touchdown_time - plan.liftoff_time)}};
  json["certificate"] = Json::array();
  for (std::size_t i = 0; i < plan.certificate.count; ++i) {
    const core::CertificateEntry& entry = plan.certificate.entries[i];
    json["certificate"].push_back(
        {{"name", entry.name}, {"margin", number(entry.margin)}, {"at_s", number(entry.time)}});
  }
  json["path"] = Json::array();
  for (std::size_t i = 0; i < plan.knot_count; ++i) {
    const Eigen::Vector3d& p = plan.knots[i].p_WG;
    json["path"].push_back({number(p.x()), number(p.y()), number(p.z())});
  }
  return json;
}

}  // namespace

ProposalDesk::ProposalDesk(const ProgramConfig& config, const model::RobotParameters& robot)
    : config_(config),
      selector_(config.footstep, robot),
      planner_(config.planner, robot, shipped_jumps(robot.name, config.planner.steps)) {}

void ProposalDesk::serve(const LockstepRun& run) {
  const std::lock_guard lock(mutex_);
  if (!wanted_) return;
  view_ = run.decision_view();
  if (!view_) return;  // in the air: a tick later, perhaps
  wanted_ = false;
  handed_over_.notify_one();
}

std::optional<DecisionView> ProposalDesk::wait_for_view() {
  std::unique_lock lock(mutex_);
  wanted_ = true;
  view_.reset();
  handed_over_.wait_for(lock, kPatience, [this] { return !wanted_; });
  wanted_ = false;
  return std::exchange(view_, std::nullopt);
}

std::string ProposalDesk::propose(const std::string& request) {
  const Place place = place_of(request);
  const std::lock_guard lock(one_at_a_time_);
  const std::optional<DecisionView> view = wait_for_view();
  Json json = {{"accepted", false}, {"reason", "not_now: the robot stands nowhere to jump from"}};
  if (!view) return json.dump();
  const core::TargetOverride target = target_at(place, view->terrain);
  json["distance"] = number(target.distance);
  json["lateral"] = number(target.lateral);
  json["yaw"] = number(target.yaw);
  footstep::LandingTask task;
  task.target = target;
  const core::TargetChoice choice =
      selector_.choose({view->map, view->terrain, *view->hanging}, view->rest, task);
  if (!choice.target) {
    json["reason"] = choice.refusal.text();
    return json.dump();
  }
  json["height"] = number(choice.target->height);
  json["probability"] = number(choice.target->safe_probability);
  json["margin"] = number(choice.target->margin);
  const Stopwatch watch;
  const core::Result<core::JumpPlan> plan = planner_.plan({.start = view->rest,
                                                           .target = *choice.target,
                                                           .final_posture = config_.stand_posture,
                                                           .id = 0});
  json["solve_ms"] = number(watch.milliseconds());
  json["accepted"] = plan.has_value();
  json["reason"] = plan ? "" : plan.error().text();
  if (plan) json["plan"] = plan_of(*plan);
  return json.dump();
}

}  // namespace hopscotch::apps
