#include "apps/report_motors.hpp"

#include <array>
#include <cmath>

#include "apps/report_chart.hpp"
#include "model/motor.hpp"

namespace hopscotch::apps {

namespace {

using core::Joint;

/// The joints that make a jump; yaw and roll only hold.
constexpr std::array<Joint, 3> kShown{Joint::hip_pitch, Joint::knee, Joint::ankle};
constexpr std::array<const char*, 3> kShownNames{"Hip pitch", "Knee", "Ankle"};
constexpr double kRoom = 1.15;  // of an axis beyond the limit

template <typename Quantity>
std::vector<Curve> leg_curves(const RunRecord& run, Quantity quantity) {
  std::vector<Curve> curves;
  for (const core::Leg leg : core::kAllLegs) {
    const std::string name(core::kLegNames[core::index(leg)]);
    Curve& curve = curves.emplace_back(Curve{name, "", {}, Curve::Mark::line});
    for (const Moment& moment : run.moments) {
      curve.points.emplace_back(moment.time, quantity(moment.motors[core::index(leg)]));
    }
  }
  return curves;
}

Chart time_chart(const RunRecord& run, const std::string& title, const std::string& unit) {
  Chart chart;
  chart.title = title;
  chart.unit = unit;
  chart.x = {0.0, run.moments.empty() ? 1.0 : run.moments.back().time};
  chart.phases = run.phases;
  return chart;
}

std::string torque_chart(const RunRecord& run, std::size_t shown) {
  const auto joint = static_cast<Eigen::Index>(core::index(kShown[shown]));
  const double most = run.robot.motors[core::index(kShown[shown])].torque_max;
  Chart chart = time_chart(run, std::string(kShownNames[shown]) + " torque", "[N·m]");
  chart.curves = leg_curves(run, [&](const MotorUse& use) { return use.torque(joint); });
  chart.limits = {{most, true}, {-most, false}};
  chart.y = {-kRoom * most, kRoom * most};
  return draw(chart);
}

std::string speed_chart(const RunRecord& run, std::size_t shown) {
  const auto joint = static_cast<Eigen::Index>(core::index(kShown[shown]));
  const double most = run.robot.motors[core::index(kShown[shown])].speed_max;
  Chart chart = time_chart(run, std::string(kShownNames[shown]) + " speed", "[rad/s]");
  chart.curves = leg_curves(run, [&](const MotorUse& use) { return use.speed(joint); });
  chart.limits = {{most, true}, {-most, false}};
  chart.y = y_range(chart.curves, {-kRoom * most, kRoom * most});
  return draw(chart);
}

std::string power_chart(const RunRecord& run, std::size_t shown) {
  const auto joint = static_cast<Eigen::Index>(core::index(kShown[shown]));
  Chart chart =
      time_chart(run, std::string(kShownNames[shown]) + " power", "[W], + drives, − brakes");
  chart.curves = leg_curves(run, [&](const MotorUse& use) { return use.power(joint); });
  chart.limits = {{run.robot.motor_power_max, true}, {-run.robot.braking_power_max, false}};
  chart.y = y_range(chart.curves,
                    {-0.5 * kRoom * run.robot.motor_power_max, kRoom * run.robot.motor_power_max});
  return draw(chart);
}

Curve envelope(const RunRecord& run, Joint joint) {
  constexpr int kSteps = 160;
  const double fastest = kRoom * run.robot.motors[core::index(joint)].speed_max;
  Curve curve{"envelope", "", {}, Curve::Mark::line};
  const auto speed = [&](int i) { return fastest * (2.0 * i / kSteps - 1.0); };
  for (int i = 0; i <= kSteps; ++i) {
    curve.points.emplace_back(speed(i), model::torque_bounds(run.robot, joint, speed(i)).upper);
  }
  for (int i = kSteps; i >= 0; --i) {
    curve.points.emplace_back(speed(i), model::torque_bounds(run.robot, joint, speed(i)).lower);
  }
  curve.points.push_back(curve.points.front());
  return curve;
}

std::string envelope_chart(const RunRecord& run, std::size_t shown) {
  const auto joint = static_cast<Eigen::Index>(core::index(kShown[shown]));
  const model::MotorParameters& motor = run.robot.motors[core::index(kShown[shown])];
  Chart chart;
  chart.title = std::string(kShownNames[shown]) + " torque over speed";
  chart.unit = "[N·m]";
  chart.height = 230.0;
  chart.x_label = "speed [rad/s]";
  chart.x = {-kRoom * motor.speed_max, kRoom * motor.speed_max};
  chart.y = {-kRoom * motor.torque_max, kRoom * motor.torque_max};
  for (const core::Leg leg : core::kAllLegs) {
    const std::string name(core::kLegNames[core::index(leg)]);
    Curve& curve = chart.curves.emplace_back(Curve{name, "", {}, Curve::Mark::dots});
    for (const Moment& moment : run.moments) {
      const MotorUse& use = moment.motors[core::index(leg)];
      curve.points.emplace_back(use.speed(joint), use.torque(joint));
    }
  }
  chart.curves.push_back(envelope(run, kShown[shown]));
  return draw(chart);
}

}  // namespace

std::string draw_motor_charts(const RunRecord& run) {
  std::string html;
  for (std::size_t i = 0; i < kShown.size(); ++i) html += torque_chart(run, i);
  for (std::size_t i = 0; i < kShown.size(); ++i) html += speed_chart(run, i);
  for (std::size_t i = 0; i < kShown.size(); ++i) html += power_chart(run, i);
  return html;
}

std::string draw_motor_envelopes(const RunRecord& run) {
  std::string html;
  for (std::size_t i = 0; i < kShown.size(); ++i) html += envelope_chart(run, i);
  return html;
}

}  // namespace hopscotch::apps
