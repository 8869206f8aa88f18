#include "apps/web_json.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>
#include <nlohmann/json.hpp>
#include <span>

#include "model/kinematics.hpp"
#include "model/motor.hpp"
#include "model/rigid_body.hpp"

namespace hopscotch::apps {

namespace {

using Json = nlohmann::ordered_json;

Json number(double value) {
  return std::isfinite(value) ? Json(std::round(value * 1e4) / 1e4) : Json();
}
Json vector(const Eigen::Vector3d& v) {
  return {number(v.x()), number(v.y()), number(v.z())};
}

template <typename Range>
Json numbers(const Range& range) {
  Json list = Json::array();
  for (const double value : range) list.push_back(number(value));
  return list;
}

Json happening(std::string_view kind, core::Stamp now) {
  return {{"kind", kind}, {"t", number(now.seconds())}};
}

/// One digit per state, in the order of CellState.
template <typename Range, typename StateOf>
std::string states(const Range& range, StateOf state_of) {
  std::string text;
  for (const auto& item : range) text += static_cast<char>('0' + static_cast<int>(state_of(item)));
  return text;
}

Json target_of(const core::LandingTarget& target) {
  Json soles = Json::array();
  for (const Eigen::Isometry3d& X_WF : target.X_WF) {
    soles.push_back({{"p", vector(X_WF.translation())},
                     {"yaw", number(std::atan2(X_WF.linear()(1, 0), X_WF.linear()(0, 0)))}});
  }
  return {{"distance", number(target.distance)},
          {"height", number(target.height)},
          {"margin", number(target.margin)},
          {"probability", number(target.safe_probability)},
          {"source", core::target_source_name(target.source)},
          {"soles", soles}};
}

/// Largest share of its limits that any motor uses.
struct MotorShare {
  double torque = 0.0;
  double speed = 0.0;
  double power = 0.0;
};
MotorShare motor_share(const WebMoment& moment, const model::RobotParameters& robot) {
  MotorShare share;
  for (const core::Leg leg : core::kAllLegs) {
    const int at = core::leg_offset(leg);
    const model::MotorLoad load =
        model::motor_load(robot, moment.tau.segment<core::kJointsPerLeg>(at),
                          moment.shown.dq.segment<core::kJointsPerLeg>(at));
    share.torque = std::max(share.torque, load.torque_ratio.maxCoeff());
    share.speed = std::max(share.speed, load.speed_ratio.maxCoeff());
    share.power = std::max(share.power, load.power_ratio.maxCoeff());
  }
  return share;
}

void append(Json& list, const Eigen::Vector3d& v) {
  for (const double value : {v.x(), v.y(), v.z()}) list.push_back(number(value));
}

/// Hip, knee, ankle, toe and heel of both legs.
void append_legs(Json& list, const core::RobotState& state, const model::RobotParameters& robot) {
  const auto soles = model::sole_poses(robot, state);
  for (const core::Leg leg : core::kAllLegs) {
    const core::LegVector q = state.q.segment<core::kJointsPerLeg>(core::leg_offset(leg));
    const model::LegPoses poses = model::leg_poses(robot, leg, q);
    for (const core::Joint joint :
         {core::Joint::hip_pitch, core::Joint::knee, core::Joint::ankle}) {
      append(list, state.p_WB + state.R_WB * poses.X_BL[core::index(joint)].translation());
    }
    const model::SoleTips tips = model::sole_tips(robot, soles[core::index(leg)]);
    append(list, tips.toe);
    append(list, tips.heel);
  }
}

}  // namespace

void WebWork::include(const msgs::StageTimes& times) {
  const auto keep = [](double& most, double ms) {
    if (!std::isnan(ms) && !(most >= ms)) most = ms;
  };
  keep(longest.tick_ms, times.tick_ms);
  keep(longest.mpc_ms, times.mpc_ms);
  keep(longest.plan_ms, times.plan_ms);
  keep(longest.perception_ms, times.perception_ms);
  keep(longest.estimator_ms, times.estimator_ms);
}

std::string quoted_json(std::string_view text) {
  return Json(text).dump(-1, ' ', false, Json::error_handler_t::replace);
}

std::string frame_columns_json() {
  Json names = {"t", "phase", "jump", "plan", "plan_time", "held", "fault", "misses"};
  const auto point = [&names](const std::string& name) {
    for (const char* axis : {"_x", "_y", "_z"}) names.push_back(name + axis);
  };
  point("trunk");
  for (const char* name : {"qx", "qy", "qz", "qw"}) names.push_back(name);
  for (const std::string_view leg : core::kLegNames) {
    for (const char* part : {"hip", "knee", "ankle", "toe", "heel"}) {
      point(std::string(leg) + "_" + part);
    }
  }
  point("com");
  for (const char* name :
       {"force_left", "force_right", "force_asked", "torque", "speed", "power", "position_error",
        "tick_ms", "mpc_ms", "plan_ms", "perception_ms", "estimator_ms"}) {
    names.push_back(name);
  }
  return names.dump();
}

std::string frame_json(const WebMoment& moment, const model::RobotParameters& robot) {
  const core::ControlStatus& control = moment.status.control;
  Json list = Json::array();
  list.push_back(number(control.stamp.seconds()));
  list.push_back(core::robot_phase_name(control.phase));
  list.push_back(moment.status.jump);
  list.push_back(control.plan_id);
  list.push_back(number(control.plan_time));
  list.push_back(moment.status.held ? 1 : 0);
  list.push_back(core::reason_code(control.fault));
  list.push_back(moment.status.deadline_misses);
  append(list, moment.shown.p_WB);
  const Eigen::Quaterniond q(moment.shown.R_WB);
  for (const double value : {q.x(), q.y(), q.z(), q.w()}) list.push_back(number(value));
  append_legs(list, moment.shown, robot);
  append(list, model::composite_body(robot, moment.shown).p_WG);
  const MotorShare share = motor_share(moment, robot);
  const msgs::StageTimes& work = moment.work.longest;
  for (const double value :
       {moment.ground[0].force.z(), moment.ground[1].force.z(),
        control.wrenches[0].force.z() + control.wrenches[1].force.z(), share.torque, share.speed,
        share.power, (moment.believed.p_WB - moment.shown.p_WB).norm(), work.tick_ms, work.mpc_ms,
        work.plan_ms, work.perception_ms, work.estimator_ms}) {
    list.push_back(number(value));
  }
  return list.dump();
}

std::string robot_json(const model::RobotParameters& robot) {
  const Json json = {{"name", robot.name},
                     {"trunk_box", vector(robot.trunk_box)},
                     {"thigh_radius", number(robot.thigh_radius)},
                     {"shank_radius", number(robot.shank_radius)},
                     {"foot_width", number(robot.foot_width)},
                     {"foot_length", number(robot.toe + robot.heel)},
                     {"weight_N", number(9.81 * robot.total_mass())}};
  return json.dump();
}

std::string scene_json(const msgs::Scene& scene) {
  Json slabs = Json::array();
  for (std::size_t i = 0; i < scene.slab_count; ++i) {
    Json corners = Json::array();
    for (const Eigen::Vector3d& corner : scene.slabs[i].top) corners.push_back(vector(corner));
    slabs.push_back({{"top", corners}, {"seen_rise", number(scene.slabs[i].seen_rise)}});
  }
  const Json json = {
      {"goal_x", number(scene.goal_x)}, {"pit_z", number(scene.pit_z)}, {"slabs", slabs}};
  return json.dump();
}

std::string terrain_json(core::Stamp now, const core::OneStepTerrain& terrain) {
  constexpr std::array<std::string_view, 4> kKinds{"up", "down", "gap_near", "gap_far"};
  Json json = happening("terrain", now);
  json["p"] = vector(terrain.p_WS);
  json["heading"] = number(terrain.heading);
  json["coverage"] = number(terrain.coverage);
  json["start"] = core::TerrainProfile::kStart;
  json["step"] = core::TerrainProfile::kStep;
  json["mean"] = numbers(terrain.profile.mean);
  json["upper"] = numbers(terrain.profile.upper);
  json["state"] = states(terrain.profile.state, [](core::CellState state) { return state; });
  json["edges"] = Json::array();
  for (std::size_t i = 0; i < terrain.edge_count; ++i) {
    const core::TerrainEdge& edge = terrain.edges[i];
    json["edges"].push_back({{"x", number(edge.x)},
                             {"sigma", number(edge.sigma)},
                             {"step", number(edge.step)},
                             {"kind", kKinds.at(static_cast<std::size_t>(edge.kind))}});
  }
  return json.dump();
}

std::string choice_json(core::Stamp now, const core::TargetChoice& choice,
                        const WebStance& stance) {
  Json json = happening("choice", now);
  json["p"] = vector(stance.p_WS);
  json["heading"] = number(stance.heading);
  json["target"] = choice.target ? target_of(*choice.target) : Json();
  json["refusal"] = choice.target ? "" : choice.refusal.text();
  json["ranked"] = Json::array();
  for (std::size_t i = 0; i < choice.ranked_count; ++i) {
    const core::RankedTarget& place = choice.ranked[i];
    json["ranked"].push_back({{"distance", number(place.distance)},
                              {"height", number(place.height)},
                              {"margin", number(place.margin)},
                              {"tread", number(place.tread)},
                              {"probability", number(place.safe_probability)}});
  }
  json["rejected"] = Json::array();
  for (std::size_t i = 0; i < choice.rejected_count; ++i) {
    json["rejected"].push_back({{"distance", number(choice.rejected[i].distance)},
                                {"why", core::reason_code(choice.rejected[i].why)}});
  }
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

std::string plan_json(core::Stamp now, const core::JumpPlan& plan) {
  Json json = happening("plan", now);
  json["id"] = plan.id;
  json["status"] = core::plan_status_name(plan.status);
  json["iterations"] = plan.iterations;
  json["duration"] = number(plan.duration);
  json["liftoff"] = number(plan.liftoff_time);
  json["touchdown"] = number(plan.touchdown_time);
  json["peaks"] = {{"torque", number(plan.peaks.torque_ratio)},
                   {"speed", number(plan.peaks.speed_ratio)},
                   {"power", number(plan.peaks.power_ratio)},
                   {"normal_force", number(plan.peaks.normal_force)}};
  json["target"] = target_of(plan.target);
  json["path"] = Json::array();
  for (std::size_t i = 0; i < plan.knot_count; ++i)
    json["path"].push_back(vector(plan.knots[i].p_WG));
  return json.dump();
}

std::string map_json(core::Stamp now, const msgs::MapView& map) {
  Json json = happening("map", now);
  json["origin"] = {number(map.origin_x), number(map.origin_y)};
  json["resolution"] = map.resolution;
  json["size"] = {map.size_x, map.size_y};
  json["height_mm"] = map.height_mm;
  json["state"] = states(map.state, [](core::CellState state) { return state; });
  return json.dump();
}

std::string ack_json(core::Stamp now, const msgs::Ack& ack) {
  Json json = happening("ack", now);
  json["channel"] = ack.channel;
  json["sequence"] = ack.command_sequence;
  json["accepted"] = ack.accepted;
  json["reason"] = core::reason_code(ack.refusal.reason);
  json["sentence"] = ack.refusal.sentence;
  json["start_in"] = number(ack.start_in);
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace hopscotch::apps
