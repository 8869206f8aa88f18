#include "planner/nearest_target.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>

namespace hopscotch::planner {

namespace {

constexpr double kEasyDistance = 0.35;  // [m]
constexpr int kBisections = 5;
/// Where the search for a feasible end of a line stands: beyond these nothing has ever been planned
/// [m]. What lies beyond is cut off first, so that bisection does not waste its steps there.
constexpr double kDistanceEnd = 0.9;
constexpr double kHeightEnd = 0.5;

double between(double from, double to, double s) {
  return from + s * (to - from);
}

double separation(const StepRequest& a, const StepRequest& b) {
  return std::hypot(std::hypot(a.distance - b.distance, a.height - b.height),
                    std::hypot(a.lateral - b.lateral, a.yaw - b.yaw));
}

/// The line from the refused jump to an easier one. The edge keeps its place relative to the target
/// for a jump up, to the start for a jump down.
struct Line {
  StepRequest from;
  StepRequest to;

  [[nodiscard]] StepRequest at(double s) const {
    StepRequest step = from;
    step.distance = between(from.distance, to.distance, s);
    step.height = between(from.height, to.height, s);
    step.lateral = between(from.lateral, to.lateral, s);
    step.yaw = between(from.yaw, to.yaw, s);
    if (from.height >= 0.0) step.edge = step.distance - (from.distance - from.edge);
    return step;
  }
};

class Search {
 public:
  Search(JumpPlanner& planner, const PlanRequest& request, const StepRequest& refused,
         const model::RobotParameters& robot)
      : planner_(planner), request_(request), refused_(refused), robot_(robot) {}

  void along(const Line& line) {
    if (!plans(line.at(1.0))) return;
    double refused = 0.0;
    double planned = 1.0;
    for (int i = 0; i < kBisections; ++i) {
      const double middle = 0.5 * (refused + planned);
      (plans(line.at(middle)) ? planned : refused) = middle;
    }
  }

  [[nodiscard]] const std::optional<NearestTarget>& best() const { return best_; }

 private:
  bool plans(const StepRequest& step) {
    request_.target = step_target(step, robot_);
    const core::Result<core::JumpPlan> plan = planner_.plan(request_);
    if (!plan) return false;
    request_.guess = StartGuess::previous;
    if (!best_ || separation(step, refused_) < separation(best_->step, refused_)) {
      best_ = NearestTarget{step, plan->certificate.binding()};
    }
    return true;
  }

  JumpPlanner& planner_;
  PlanRequest request_;
  StepRequest refused_;
  const model::RobotParameters& robot_;
  std::optional<NearestTarget> best_;
};

}  // namespace

std::optional<NearestTarget> nearest_target(JumpPlanner& planner, const PlanRequest& request,
                                            const StepRequest& refused,
                                            const model::RobotParameters& robot) {
  const bool finite = std::isfinite(refused.distance) && std::isfinite(refused.height) &&
                      std::isfinite(refused.edge) && std::isfinite(refused.lateral) &&
                      std::isfinite(refused.yaw);
  if (!finite) return std::nullopt;
  Search search(planner, request, refused, robot);
  StepRequest from = refused;
  from.distance = std::clamp(from.distance, 0.1, kDistanceEnd);
  from.height = std::clamp(from.height, -kHeightEnd, kHeightEnd);
  if (refused.height >= 0.0) from.edge = from.distance - (refused.distance - refused.edge);
  StepRequest ahead = from;
  ahead.lateral = ahead.yaw = 0.0;
  StepRequest nearer = from;
  nearer.distance = kEasyDistance;
  StepRequest level = from;
  level.height = 0.0;
  StepRequest easy = ahead;
  easy.distance = kEasyDistance;
  easy.height = 0.0;
  for (const StepRequest& to : {easy, ahead, nearer, level}) {
    if (separation(from, to) > 0.0) search.along({from, to});
  }
  return search.best();
}

}  // namespace hopscotch::planner
