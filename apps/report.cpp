#include "apps/report.hpp"

#include <algorithm>
#include <numbers>
#include <string>

#include "apps/html.hpp"
#include "apps/report_chart.hpp"
#include "apps/report_data.hpp"
#include "apps/report_motors.hpp"
#include "apps/report_pictures.hpp"
#include "apps/report_side_view.hpp"
#include "apps/report_style.hpp"
#include "apps/report_summary.hpp"
#include "apps/report_targets.hpp"
#include "apps/run_folder.hpp"
#include "apps/text_file.hpp"

namespace hopscotch::apps {

namespace {

std::string section(const std::string& title, const std::string& lead, const std::string& content) {
  return "<section><h2>" + title + "</h2><p class=\"lead\">" + lead + "</p>" + content +
         "</section>\n";
}

std::string card(const std::string& content) {
  return "<div class=\"card\">" + content + "</div>";
}
std::string grid(const std::string& content) {
  return card("<div class=\"grid\">" + content + "</div>");
}

/// Key of the phase colours.
const char* const kPhaseKey =
    "<span class=\"keys\"><span class=\"chip takeoff\">take-off</span><span class=\"chip "
    "flight\">flight</span><span class=\"chip landing\">landing</span><span class=\"chip "
    "stand\">standing</span></span>";

/// Key of the legs' colours.
const char* const kLegKey =
    "<span class=\"keys\"><span class=\"chip left-leg\">left leg</span><span class=\"chip "
    "right-leg\">right leg</span></span>";

std::string head(const RunResult& result) {
  return "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">"
         "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">"
         "<link rel=\"icon\" href=\"data:,\"><title>" +
         escape(result.scenario + ": " + std::string(run_outcome_name(result.outcome))) +
         "</title><style>" + std::string(kReportStyle) + "</style></head>\n<body><main>\n";
}

std::string opening(const RunRecord& run) {
  const RunResult& result = run.result;
  const bool good = result.outcome == RunOutcome::completed;
  const bool bad = result.outcome == RunOutcome::fell || result.outcome == RunOutcome::fault;
  const std::string style = good ? "badge good" : (bad ? "badge bad" : "badge");
  return "<header><span class=\"" + style + "\">" +
         escape(std::string(run_outcome_name(result.outcome))) + "</span><h1>" +
         escape(headline(result)) + "</h1><p class=\"lead\">Terrain from the " +
         escape(result.perception == "camera" ? "depth camera" : result.perception) +
         ", state by " + escape(result.state) + ", robot “" + escape(run.robot.name) + "”, seed " +
         std::to_string(result.seed) + ", program " + escape(result.program) + ", run " +
         escape(result.run_id) + ".</p></header>\n" + draw_tiles(result);
}

std::string crossing_section(const RunRecord& run) {
  const std::string controls =
      "<div class=\"controls\" id=\"replay-controls\" hidden><button id=\"play\" "
      "type=\"button\">Play</button><input id=\"slider\" type=\"range\" min=\"0\" max=\"0\" "
      "value=\"0\" aria-label=\"Time\"><span id=\"clock\"></span><select id=\"speed\" "
      "aria-label=\"Speed\"><option value=\"1\">1 ×</option><option value=\"0.5\">½ ×</option>"
      "<option value=\"0.25\">¼ ×</option><option value=\"0.1\">⅒ ×</option></select></div>";
  const std::string lead =
      "To scale. Solid line: centre of mass as flown, coloured by phase; dashed: as planned. Teal: "
      "ground as the robot saw it before each jump; red dots: where perception was misled. "
      "Brackets "
      "below the ground: where the soles were to land; black bars: where they stood.";
  return section("The crossing, from the side", lead + kPhaseKey,
                 card(draw_crossing(run) + controls)) +
         "<script type=\"application/json\" id=\"replay-data\">" + replay_data(run) + "</script>\n";
}

std::string jumps_section(const RunRecord& run) {
  std::string figures;
  for (const JumpRecord& jump : run.jumps) figures += draw_jump(run, jump);
  return section(
      "Jump by jump",
      "Margins are the support left beyond toe and heel at rest. Peaks are shares of the "
      "motors’ limits as flown. ×: how often the rest of the jump was planned anew.",
      card(draw_jump_table(run.result)) + (figures.empty() ? "" : grid(figures)));
}

Chart wide_chart(const RunRecord& run, const std::string& title, const std::string& unit) {
  Chart chart;
  chart.title = title;
  chart.unit = unit;
  chart.width = 1100.0;
  chart.height = 230.0;
  chart.x = {0.0, run.moments.empty() ? 1.0 : run.moments.back().time};
  chart.phases = run.phases;
  return chart;
}

std::string force_chart(const RunRecord& run) {
  Chart chart = wide_chart(run, "Vertical ground force, both feet", "[N]");
  Curve planned{"planned", "planned", {}, Curve::Mark::line};
  Curve measured{"measured", "measured", {}, Curve::Mark::line};
  for (const Moment& moment : run.moments) {
    planned.points.emplace_back(moment.time, moment.planned_normal_force);
    measured.points.emplace_back(moment.time, moment.normal_force);
  }
  chart.curves = {measured, planned};
  chart.y = y_range(chart.curves, {0.0, 100.0});
  return "<div class=\"scroll\">" + draw(chart) + "</div>";
}

std::string pitch_chart(const RunRecord& run) {
  constexpr double kDegrees = 180.0 / std::numbers::pi;
  Chart chart = wide_chart(run, "Trunk pitch, nose down positive", "[°]");
  Curve planned{"planned", "planned", {}, Curve::Mark::line};
  Curve measured{"measured", "flown", {}, Curve::Mark::line};
  for (const Moment& moment : run.moments) {
    planned.points.emplace_back(moment.time, kDegrees * moment.planned_pitch);
    measured.points.emplace_back(moment.time, kDegrees * moment.pitch);
  }
  chart.curves = {measured, planned};
  chart.y = y_range(chart.curves, {-5.0, 5.0});
  return "<div class=\"scroll\">" + draw(chart) + "</div>";
}

std::string times_section(const RunRecord& run) {
  const std::string lead =
      "Wall time on the machine of the run; solid line: median, dashed: 99th percentile. "
      "Deadline misses: " +
      std::to_string(run.result.timing.deadline_misses) + ".";
  return section("Computing times", lead,
                 grid(draw_histogram("Jump plan (Ipopt)", run.planning) +
                      draw_histogram("MPC solve", run.balancing) +
                      draw_histogram("Perception, per depth frame", run.perceiving) +
                      draw_histogram("Control tick", run.ticks)));
}

std::string files_section(const RunFolder& folder) {
  std::string list;
  const auto add = [&](const std::filesystem::path& file, const std::string& meaning) {
    if (!std::filesystem::exists(file)) return;
    const std::string name = escape(file.filename().string());
    list += "<li><a href=\"" + name + "\">" + name + "</a> " + meaning + "</li>";
  };
  add(folder.video(), "the run as a film");
  add(folder.log(), "every message of the run; <code>lcm-logplayer</code> plays it");
  add(folder.result(), "the figures of this page for programs");
  add(folder.config(), "scenario and tuning as used");
  return section("Files", "Beside this page.", card("<ul>" + list + "</ul>"));
}

std::string page(const RunFolder& folder, const RunRecord& run) {
  const std::string picture = embed_crossing_picture(folder);
  const std::string frames = embed_key_frames(folder);
  std::string html = head(run.result) + opening(run);
  if (!picture.empty()) html += card(picture);
  html += crossing_section(run) + jumps_section(run);
  if (!frames.empty()) {
    html += section("Key frames", "Crouch, lift-off, apex, touchdown and rest of every jump.",
                    card("<div class=\"grid frames\">" + frames + "</div>"));
  }
  html += section("Where to land",
                  "The ground ahead as the robot saw it [m], grey where it saw nothing. Crosses: "
                  "places looked at and rejected; dots: places that would do; purple: the choice.",
                  grid(draw_target_choices(run)));
  html +=
      section("Forces and balance", std::string("Background: the phases of the jumps.") + kPhaseKey,
              card(force_chart(run) + pitch_chart(run)));
  html +=
      section("Motors against their limits",
              std::string("As applied, each motor’s own share, referred to the joint side of its "
                          "reduction. Shaded: beyond the limit; the closed line is the envelope of "
                          "torque, speed and power.") +
                  kLegKey,
              grid(draw_motor_charts(run)) + grid(draw_motor_envelopes(run)));
  html += times_section(run) + files_section(folder);
  if (run.malformed > 0) {
    html += "<p class=\"lead\">" + std::to_string(run.malformed) +
            " messages of the log could not be read.</p>";
  }
  return html + "</main><script>" + std::string(kReportScript) + "</script></body></html>\n";
}

}  // namespace

void write_report(const std::filesystem::path& run_dir) {
  const RunFolder folder{run_dir};
  const RunRecord run = load_run(folder);
  write_file_atomically(folder.report(), page(folder, run));
}

}  // namespace hopscotch::apps
