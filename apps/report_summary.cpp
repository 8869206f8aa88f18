#include "apps/report_summary.hpp"

#include <algorithm>
#include <cmath>

#include "apps/html.hpp"

namespace hopscotch::apps {

namespace {

std::size_t landed_count(const RunResult& result) {
  return static_cast<std::size_t>(
      std::count_if(result.jumps.begin(), result.jumps.end(),
                    [](const JumpResult& jump) { return jump.outcome == JumpOutcome::landed; }));
}

std::string jumps_text(std::size_t count) {
  return std::to_string(count) + (count == 1 ? " jump" : " jumps");
}

/// Largest finite value of a member over all jumps; NaN without any.
template <typename Member>
double largest(const RunResult& result, Member member) {
  double most = core::kNaN;
  for (const JumpResult& jump : result.jumps) most = std::fmax(most, member(jump));
  return most;
}

double covered_distance(const RunResult& result) {
  double sum = 0.0;
  for (const JumpResult& jump : result.jumps) {
    if (std::isfinite(jump.landing.distance)) sum += jump.landing.distance;
  }
  return sum;
}

std::string tile(const std::string& value, const std::string& meaning) {
  return "<div class=\"tile\"><b>" + escape(value) + "</b><span>" + escape(meaning) +
         "</span></div>";
}

std::string percent(double ratio) {
  return std::isfinite(ratio) ? fixed(100.0 * ratio, 0) + " %" : "–";
}
std::string metres(double value) {
  return fixed(value, 3);
}
std::string millimetres(double value) {
  return fixed(1000.0 * value, 0);
}

std::string cell(const std::string& text, const std::string& style = "") {
  return (style.empty() ? "<td>" : "<td class=\"" + style + "\">") + escape(text) + "</td>";
}

/// "0.400, +0.050"
std::string place(double distance, double height) {
  return metres(distance) + ", " + (height > 0.0 ? "+" : "") + metres(height);
}

std::string margins_cell(const JumpResult::Landing& landing) {
  const bool over = landing.toe_margin < 0.0 || landing.heel_margin < 0.0;
  return cell(millimetres(landing.toe_margin) + " / " + millimetres(landing.heel_margin),
              over ? "bad" : "");
}

std::string peaks_cell(const JumpResult::Peak& peak) {
  const bool beyond = peak.torque_ratio > 1.0 || peak.power_ratio > 1.0;
  return cell(percent(peak.torque_ratio) + " / " + percent(peak.speed_ratio) + " / " +
                  percent(peak.power_ratio),
              beyond ? "bad" : "");
}

/// The reason why a jump went wrong, else the tightest limit of its plan.
std::string remark(const JumpResult& jump) {
  if (!jump.reason.empty()) return jump.reason;
  if (jump.plan.binding_name.empty()) return "";
  return jump.plan.binding_name + ", " + percent(jump.plan.binding_margin) + " left";
}

std::string jump_row(const JumpResult& jump) {
  const bool good = jump.outcome == JumpOutcome::landed;
  std::string row = "<tr>" + cell(std::to_string(jump.index)) +
                    cell(std::string(jump_outcome_name(jump.outcome)), good ? "good" : "bad");
  row += cell(place(jump.target.distance, jump.target.height)) +
         cell(place(jump.landing.distance, jump.landing.height)) + margins_cell(jump.landing);
  row += cell(fixed(jump.takeoff.speed_x, 2) + " / " + fixed(jump.takeoff.speed_z, 2)) +
         cell(fixed(jump.flight, 3));
  row += peaks_cell(jump.peak) + cell(fixed(jump.peak.normal_force, 0));
  row += cell(std::to_string(jump.plan.iterations) + (jump.plan.warm ? " warm" : " cold") + ", " +
              std::to_string(jump.plan.replanned) + " ×");
  return row + cell(remark(jump)) + "</tr>\n";
}

}  // namespace

std::string headline(const RunResult& result) {
  const std::string jumps = jumps_text(landed_count(result));
  const std::string time = fixed(result.duration, 1) + " s";
  const std::string why = result.reason.empty() ? "" : " — " + result.reason;
  switch (result.outcome) {
    case RunOutcome::completed:
      return "HECTOR crossed “" + result.scenario + "” with " + jumps + " in " + time + ".";
    case RunOutcome::refused:
      return "HECTOR made " + jumps + " on “" + result.scenario + "”, then stood and refused" + why;
    case RunOutcome::fell: return "HECTOR fell on “" + result.scenario + "” after " + jumps + why;
    case RunOutcome::fault:
      return "HECTOR stopped on “" + result.scenario + "” after " + jumps + " with a fault" + why;
    case RunOutcome::stopped:
      return "HECTOR was stopped on “" + result.scenario + "” after " + jumps + why;
  }
  return "";
}

std::string draw_tiles(const RunResult& result) {
  const double margin = -largest(result, [](const JumpResult& jump) {
    return -std::fmin(jump.landing.toe_margin, jump.landing.heel_margin);
  });
  const double load = std::fmax(
      std::fmax(largest(result, [](const JumpResult& jump) { return jump.peak.torque_ratio; }),
                largest(result, [](const JumpResult& jump) { return jump.peak.speed_ratio; })),
      largest(result, [](const JumpResult& jump) { return jump.peak.power_ratio; }));
  std::string html = "<div class=\"tiles\">";
  html += tile(std::to_string(landed_count(result)) + " / " + std::to_string(result.jumps.size()),
               "jumps landed");
  html += tile(fixed(covered_distance(result), 2) + " m", "covered by jumping");
  html += tile(fixed(result.duration, 1) + " s", "simulated time");
  html += tile(millimetres(margin) + " mm", "least support beyond a toe or heel");
  html += tile(percent(load), "highest use of a motor limit");
  html += tile(fixed(result.timing.plan_ms.p50, 0) + " ms", "median time to plan a jump");
  html += tile(fixed(result.timing.mpc_ms.p99, 2) + " ms", "99 % of MPC solves are faster");
  html += tile(fixed(result.timing.real_time_factor, 1) + " ×", "faster than real time");
  return html + "</div>\n";
}

std::string draw_jump_table(const RunResult& result) {
  if (result.jumps.empty()) return "<p>No jump was started.</p>";
  std::string html =
      "<div class=\"scroll\"><table><thead><tr><th>#</th><th>outcome</th><th>wanted<br>x, z "
      "[m]</th><th>landed<br>x, z [m]</th><th>support beyond<br>toe / heel [mm]</th><th>take-off "
      "speed<br>x / z [m/s]</th><th>flight<br>[s]</th><th>peak torque /<br>speed / power</th>"
      "<th>peak force<br>[N]</th><th>plan<br>iterations</th><th>tightest limit<br>of the plan</th>"
      "</tr></thead><tbody>\n";
  for (const JumpResult& jump : result.jumps) html += jump_row(jump);
  return html + "</tbody></table></div>\n";
}

}  // namespace hopscotch::apps
