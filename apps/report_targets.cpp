#include "apps/report_targets.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "apps/html.hpp"

namespace hopscotch::apps {

namespace {

using core::TerrainProfile;

constexpr double kWidth = 340.0;  // of the drawing
constexpr double kHeight = 200.0;
constexpr double kMarksTop = 22.0;  // rows of candidates above the terrain
constexpr double kRow = 15.0;
constexpr double kGround = 120.0;  // where height 0 of S is drawn
constexpr double kScale =
    kWidth / (TerrainProfile::kStep * (TerrainProfile::kSamples - 1));  // units per metre

double u(double x) {
  return (x - TerrainProfile::kStart) * kScale;
}
double v(double z) {
  return std::clamp(kGround - z * kScale, 0.0, kHeight);
}

std::string mark(const std::string& style, double x, double y, const std::string& text) {
  return "<circle class=\"" + style + "\" cx=\"" + fixed(u(x), 1) + "\" cy=\"" + fixed(y, 1) +
         "\" r=\"3.4\"><title>" + escape(text) + "</title></circle>";
}

std::string cross(double x, double y, const std::string& text) {
  const double cu = u(x);
  return "<path class=\"rejected\" d=\"M" + fixed(cu - 2.6, 1) + " " + fixed(y - 2.6, 1) +
         "l5.2 5.2m0 -5.2l-5.2 5.2\"><title>" + escape(text) + "</title></path>";
}

std::string ground_line(const TerrainProfile& profile) {
  std::vector<Eigen::Vector2d> mean;
  std::string unseen;
  for (int i = 0; i < TerrainProfile::kSamples; ++i) {
    const auto k = static_cast<std::size_t>(i);
    const double x = TerrainProfile::x(i);
    if (profile.state[k] == core::CellState::observed) {
      mean.emplace_back(u(x), v(profile.mean[k]));
      continue;
    }
    mean.emplace_back(core::kNaN, core::kNaN);
    unseen += "<rect class=\"unseen\" x=\"" + fixed(u(x) - 1.5, 1) + "\" y=\"" +
              fixed(kGround - 4.0, 1) + "\" width=\"3\" height=\"8\"/>";
  }
  return unseen + "<path class=\"seen\" d=\"" + path_data(mean) + "\"/>";
}

std::string ruler() {
  std::string svg;
  constexpr double kStep = 0.25;  // [m]
  for (double x = 0.0; x < 1.5; x += kStep) {
    svg += "<path class=\"tick\" d=\"M" + fixed(u(x), 1) + " " + fixed(kHeight - 18.0, 1) +
           "v4\"/><text text-anchor=\"middle\" x=\"" + fixed(u(x), 1) + "\" y=\"" +
           fixed(kHeight - 4.0, 1) + "\">" + fixed(x, 2) + "</text>";
  }
  return svg;
}

std::string chosen_mark(const core::LandingTarget& target) {
  const double y = v(target.height);
  return "<path class=\"chosen\" d=\"M" + fixed(u(target.distance), 1) + " " +
         fixed(kMarksTop + kRow + 8.0, 1) + "V" + fixed(y, 1) + "\"/>" +
         "<path class=\"chosen\" d=\"M" + fixed(u(target.distance) - 16.0, 1) + " " +
         fixed(y + 4.0, 1) + "h32\"/>";
}

std::string candidate_marks(const core::TargetChoice& choice) {
  std::string svg;
  for (std::size_t i = 0; i < choice.rejected_count; ++i) {
    const core::RejectedTarget& rejected = choice.rejected[i];
    if (!std::isfinite(rejected.distance)) continue;
    svg +=
        cross(rejected.distance, kMarksTop,
              fixed(rejected.distance, 3) + " m: " + std::string(core::reason_code(rejected.why)));
  }
  for (std::size_t i = choice.ranked_count; i-- > 0;) {
    const core::RankedTarget& ranked = choice.ranked[i];
    if (!std::isfinite(ranked.distance)) continue;
    svg += mark(i == 0 ? "best" : "possible", ranked.distance, kMarksTop + kRow,
                fixed(ranked.distance, 3) + " m, height " + fixed(ranked.height, 3) +
                    " m, margin " + fixed(ranked.margin, 3) + " m, safe " +
                    fixed(100.0 * ranked.safe_probability, 1) + " %");
  }
  return svg;
}

/// "9 × out_of_reach, 4 × tread_too_short"
std::string rejection_counts(const core::TargetChoice& choice) {
  std::map<std::string, int> counts;
  for (std::size_t i = 0; i < choice.rejected_count; ++i) {
    ++counts[std::string(core::reason_code(choice.rejected[i].why))];
  }
  std::string text;
  for (const auto& [code, count] : counts) {
    text += (text.empty() ? "" : ", ") + std::to_string(count) + " × " + code;
  }
  return text.empty() ? "nothing rejected" : "rejected: " + text;
}

std::string verdict(const core::TargetChoice& choice) {
  if (!choice.target) return "refused — " + choice.refusal.text();
  const core::LandingTarget& target = *choice.target;
  return fixed(target.distance, 2) + " m ahead, " + fixed(target.height, 2) + " m high, " +
         fixed(1000.0 * target.margin, 0) + " mm from the nearest edge";
}

/// The terrain that a choice was made on: its own stamp, or the target's profile.
const TerrainProfile* profile_of(const RunRecord& run, const core::TargetChoice& choice) {
  if (choice.target) return &choice.target->profile;
  const TerrainProfile* newest = nullptr;
  for (const core::OneStepTerrain& terrain : run.terrains) {
    if (terrain.stamp <= choice.stamp) newest = &terrain.profile;
  }
  return newest;
}

std::string draw_choice(const RunRecord& run, const core::TargetChoice& choice,
                        const std::string& title) {
  std::string svg = "<path class=\"zero\" d=\"M0 " + fixed(kGround, 1) + "H" + fixed(kWidth, 1) +
                    "\"/>" + ruler();
  if (const TerrainProfile* profile = profile_of(run, choice)) svg += ground_line(*profile);
  if (choice.target) svg += chosen_mark(*choice.target);
  svg += candidate_marks(choice);
  return "<figure><figcaption><b>" + escape(title) + "</b> " + escape(verdict(choice)) +
         "<br><span class=\"unit\">" + escape(rejection_counts(choice)) +
         "</span></figcaption><svg viewBox=\"0 0 " + fixed(kWidth, 0) + " " + fixed(kHeight, 0) +
         "\" role=\"img\" aria-label=\"" + escape(title + ": " + verdict(choice)) + "\">" + svg +
         "</svg></figure>\n";
}

bool same_place(const core::LandingTarget& a, const core::LandingTarget& b) {
  return a.distance == b.distance && a.p_WS == b.p_WS;
}

}  // namespace

std::string draw_target_choices(const RunRecord& run) {
  std::string html;
  for (const JumpRecord& jump : run.jumps) {
    const core::JumpPlan* plan = run.plan_of(jump);
    if (plan == nullptr) continue;
    const auto choice = std::find_if(
        run.choices.rbegin(), run.choices.rend(), [&](const core::TargetChoice& candidate) {
          return candidate.target && same_place(*candidate.target, plan->target);
        });
    if (choice == run.choices.rend()) continue;
    html += draw_choice(run, *choice, "Jump " + std::to_string(jump.index) + ":");
  }
  if (!run.choices.empty() && !run.choices.back().target) {
    html += draw_choice(run, run.choices.back(), "No jump:");
  }
  return html.empty() ? "<p>The log holds no target choices.</p>" : html;
}

}  // namespace hopscotch::apps
