#include "apps/report_side_view.hpp"

#include <algorithm>
#include <cmath>

#include "apps/html.hpp"
#include "apps/report_chart.hpp"
#include "apps/report_figure.hpp"
#include "model/kinematics.hpp"

namespace hopscotch::apps {

namespace {

using Eigen::Vector2d;
using Points = std::vector<Vector2d>;

/// Colour of the figure at each instant: that of the phase it belongs to.
constexpr std::array<const char*, kInstantNames.size()> kInstantStyles{
    "takeoff", "takeoff", "flight", "landing", "landing"};

/// Part of the x-z plane of W and its scale, the same along both axes.
struct Window {
  double x_begin = 0.0;  ///< [m]
  double x_end = 1.0;    ///< [m]
  double z_begin = 0.0;  ///< [m]
  double z_end = 1.0;    ///< [m]
  double scale = 100.0;  ///< Drawing units per metre.

  [[nodiscard]] double width() const { return (x_end - x_begin) * scale; }
  [[nodiscard]] double height() const { return (z_end - z_begin) * scale; }
  [[nodiscard]] Vector2d map(const Vector2d& p) const {
    return {(p.x() - x_begin) * scale, (z_end - p.y()) * scale};
  }
  [[nodiscard]] Points map(Points points) const {
    for (Vector2d& p : points) {
      if (p.allFinite()) p = map(p);
    }
    return points;
  }
};

std::string path(const std::string& style, const Window& window, const Points& points) {
  return "<path class=\"" + style + "\" d=\"" + path_data(window.map(points)) + "\"/>";
}

std::string area(const std::string& style, const Window& window, const Points& points) {
  return "<path class=\"" + style + "\" d=\"" + path_data(window.map(points)) + "Z\"/>";
}

std::string caption(const Window& window, const Vector2d& p, const std::string& text) {
  const Vector2d q = window.map(p);
  return "<text class=\"note\" text-anchor=\"middle\" x=\"" + fixed(q.x(), 1) + "\" y=\"" +
         fixed(q.y(), 1) + "\">" + escape(text) + "</text>";
}

/// Near and far end of a slab's top in the side view: middle of its near and of its far edge.
std::array<Vector2d, 2> slab_line(const msgs::SceneSlab& slab, double rise) {
  const Eigen::Vector3d near_edge = 0.5 * (slab.top[0] + slab.top[3]);
  const Eigen::Vector3d far_edge = 0.5 * (slab.top[1] + slab.top[2]);
  return {Vector2d(near_edge.x(), near_edge.z() + rise),
          Vector2d(far_edge.x(), far_edge.z() + rise)};
}

std::string draw_slabs(const RunRecord& run, const Window& window) {
  constexpr double kVisibleSurprise = 0.001;  // [m]
  if (!run.scene) return "";
  std::string svg;
  for (std::size_t i = 0; i < run.scene->slab_count; ++i) {
    const msgs::SceneSlab& slab = run.scene->slabs[i];
    const auto [a, b] = slab_line(slab, 0.0);
    if (b.x() < window.x_begin || a.x() > window.x_end) continue;
    svg +=
        area("slab", window, {a, b, {b.x(), window.z_begin - 0.1}, {a.x(), window.z_begin - 0.1}});
    svg += path("slab-top", window, {a, b});
    if (std::abs(slab.seen_rise) > kVisibleSurprise) {
      const auto [c, d] = slab_line(slab, slab.seen_rise);
      svg += path("slab-seen", window, {c, d});
    }
  }
  return svg;
}

/// Observed samples of a terrain product, in W; holes interrupt the line.
Points seen_points(const core::OneStepTerrain& terrain) {
  Points points;
  for (int i = 0; i < core::TerrainProfile::kSamples; ++i) {
    const auto k = static_cast<std::size_t>(i);
    const bool seen = terrain.profile.state[k] == core::CellState::observed;
    const double x = terrain.p_WS.x() + std::cos(terrain.heading) * core::TerrainProfile::x(i);
    points.emplace_back(x, seen ? terrain.p_WS.z() + terrain.profile.mean[k] : core::kNaN);
  }
  return points;
}

/// What was known of the ground when this plan was made.
const core::OneStepTerrain* terrain_of(const RunRecord& run, const core::JumpPlan& plan) {
  const core::OneStepTerrain* newest = nullptr;
  for (const core::OneStepTerrain& terrain : run.terrains) {
    const double apart = (terrain.p_WS - plan.target.p_WS).norm();
    constexpr double kSamePlace = 0.05;  // the frame of another jump is further away [m]
    if (apart < kSamePlace) newest = &terrain;
  }
  return newest;
}

std::string draw_seen(const RunRecord& run, const Window& window, const core::JumpPlan* plan) {
  const core::OneStepTerrain* terrain = plan == nullptr ? nullptr : terrain_of(run, *plan);
  return terrain == nullptr ? "" : path("seen", window, seen_points(*terrain));
}

Points planned_path(const core::JumpPlan& plan) {
  Points points;
  for (std::size_t i = 0; i < plan.knot_count; ++i) {
    points.emplace_back(plan.knots[i].p_WG.x(), plan.knots[i].p_WG.z());
  }
  return points;
}

Points flown_path(const RunRecord& run, double begin, double end) {
  constexpr double kSpacing = 0.004;  // finer cannot be seen [m]
  Points points;
  for (const Moment& moment : run.moments) {
    if (moment.time < begin || moment.time > end) continue;
    const Vector2d p(moment.p_WG.x(), moment.p_WG.z());
    if (points.empty() || (p - points.back()).norm() > kSpacing) points.push_back(p);
  }
  return points;
}

/// Where the soles were to come to rest: a bracket under the ground.
std::string draw_target(const RunRecord& run, const Window& window, const core::JumpPlan& plan) {
  constexpr double kBelow = 0.022;  // [m]
  constexpr double kHook = 0.012;   // [m]
  const model::SoleTips tips = model::sole_tips(run.robot, plan.target.X_WF[0]);
  const Vector2d heel(tips.heel.x(), tips.heel.z() - kBelow);
  const Vector2d toe(tips.toe.x(), tips.toe.z() - kBelow);
  const Vector2d up(0.0, kHook);
  return path("target", window, {heel + up, heel, toe, toe + up});
}

/// The soles at a moment, as bars on the ground.
std::string draw_soles(const RunRecord& run, const Window& window, double time) {
  const StickFigure figure = stick_figure(run.robot, run.moment_at(time).state);
  std::string svg;
  for (const core::Leg leg : core::kAllLegs) {
    const StickFigure::LegPoints& points = figure.legs[core::index(leg)];
    svg += path("sole", window, {points.heel, points.toe});
  }
  return svg;
}

std::string draw_figure(const Window& window, const StickFigure& figure, const std::string& style) {
  std::string svg = "<g class=\"robot " + style + "\">";
  const Vector2d waist = 0.5 * (figure.trunk[0] + figure.trunk[1]);
  for (const core::Leg leg : {core::Leg::right, core::Leg::left}) {
    const StickFigure::LegPoints& p = figure.legs[core::index(leg)];
    const std::string side(core::kLegNames[core::index(leg)]);
    svg += path("limb " + side, window, {waist, p.hip, p.knee, p.ankle});
    svg += area("foot " + side, window, {p.heel, p.toe, p.ankle});
  }
  svg += area("trunk", window, {figure.trunk.begin(), figure.trunk.end()});
  return svg + "</g>";
}

std::string scale_bar(const Window& window) {
  constexpr double kLength = 0.1;  // [m]
  constexpr double kInset = 0.03;  // [m]
  const Vector2d a(window.x_begin + kInset, window.z_end - kInset);
  const Vector2d b = a + Vector2d(kLength, 0.0);
  return path("scale-bar", window, {a, b}) +
         caption(window, 0.5 * (a + b) - Vector2d(0.0, 0.045), "10 cm");
}

std::string svg_begin(const Window& window, const std::string& attributes,
                      const std::string& text) {
  return "<svg " + attributes + " viewBox=\"0 0 " + fixed(window.width(), 0) + " " +
         fixed(window.height(), 0) + "\" role=\"img\" aria-label=\"" + escape(text) + "\">";
}

/// Ground line marks every half metre along the lower border.
std::string ruler(const Window& window) {
  constexpr double kStep = 0.5;      // [m]
  constexpr double kHeight = 0.015;  // [m]
  std::string svg;
  for (double x = std::ceil(window.x_begin / kStep) * kStep; x < window.x_end; x += kStep) {
    const Vector2d p(x, window.z_begin);
    svg += path("ruler", window, {p, p + Vector2d(0.0, kHeight)});
    if (x > window.x_begin + 0.1 && x < window.x_end - 0.1) {
      svg += caption(window, p + Vector2d(0.0, 0.03), fixed(x, 1) + " m");
    }
  }
  return svg;
}

Window crossing_window(const RunRecord& run) {
  constexpr double kSide = 0.45;    // around the path, for the body [m]
  constexpr double kAbove = 0.35;   // CoM to the top of the trunk and some air [m]
  constexpr double kBelow = 0.22;   // of the lowest sole [m]
  constexpr double kScale = 300.0;  // drawing units per metre
  Window window{1e9, -1e9, 1e9, -1e9, kScale};
  constexpr std::size_t kEvery = 20;  // 20 ms are enough for a frame around it all
  for (std::size_t i = 0; i < run.moments.size(); i += kEvery) {
    const Moment& moment = run.moments[i];
    if (!moment.p_WG.allFinite()) continue;
    window.x_begin = std::min(window.x_begin, moment.p_WG.x() - kSide);
    window.x_end = std::max(window.x_end, moment.p_WG.x() + kSide);
    window.z_end = std::max(window.z_end, moment.p_WG.z() + kAbove);
    for (const Eigen::Isometry3d& X_WF : model::sole_poses(run.robot, moment.state)) {
      window.z_begin = std::min(window.z_begin, X_WF.translation().z() - kBelow);
    }
  }
  return window;
}

Window jump_window(const RunRecord& run, const JumpRecord& jump) {
  constexpr double kSide = 0.33;    // [m]
  constexpr double kAbove = 0.32;   // [m]
  constexpr double kBelow = 0.12;   // [m]
  constexpr double kScale = 400.0;  // drawing units per metre
  Window window{1e9, -1e9, 1e9, -1e9, kScale};
  for (const Moment& moment : run.moments) {
    if (moment.time < jump.begin || moment.time > jump.end) continue;
    window.x_begin = std::min(window.x_begin, moment.p_WG.x() - kSide);
    window.x_end = std::max(window.x_end, moment.p_WG.x() + kSide);
    window.z_end = std::max(window.z_end, moment.p_WG.z() + kAbove);
  }
  for (const double time : {jump.begin, jump.end}) {
    for (const Eigen::Isometry3d& X_WF : model::sole_poses(run.robot, run.moment_at(time).state)) {
      window.z_begin = std::min(window.z_begin, X_WF.translation().z() - kBelow);
    }
  }
  return window;
}

std::string goal_mark(const RunRecord& run, const Window& window) {
  if (!run.scene || !std::isfinite(run.scene->goal_x)) return "";
  const double x = run.scene->goal_x;
  if (x < window.x_begin || x > window.x_end) return "";
  constexpr double kLabelBelowTop = 0.05;  // [m]
  return path("goal", window, {{x, window.z_begin}, {x, window.z_end - kLabelBelowTop - 0.02}}) +
         caption(window, {x, window.z_end - kLabelBelowTop}, "goal");
}

}  // namespace

std::string draw_crossing(const RunRecord& run) {
  if (run.moments.empty()) return "<p>The log holds no motion.</p>";
  const Window window = crossing_window(run);
  std::string svg = draw_slabs(run, window) + ruler(window) + goal_mark(run, window);
  for (const JumpRecord& jump : run.jumps) {
    const core::JumpPlan* plan = run.plan_of(jump);
    svg += draw_seen(run, window, plan);
    if (plan == nullptr) continue;
    svg += path("com planned", window, planned_path(*plan)) + draw_target(run, window, *plan);
  }
  for (const PhaseSpan& span : run.phases) {
    svg +=
        path("com flown " + phase_style(span.phase), window, flown_path(run, span.begin, span.end));
  }
  svg += draw_soles(run, window, run.moments.front().time);
  for (const JumpRecord& jump : run.jumps) svg += draw_soles(run, window, jump.end);
  svg += draw_figure(window, stick_figure(run.robot, run.moments.front().state), "stand");
  svg += "<g id=\"live\"></g>" + scale_bar(window);
  const std::string attributes = "id=\"crossing\" data-x=\"" + fixed(window.x_begin, 4) +
                                 "\" data-z=\"" + fixed(window.z_end, 4) + "\" data-scale=\"" +
                                 fixed(window.scale, 1) +
                                 "\" style=\"min-width:" + fixed(0.62 * window.width(), 0) +
                                 "px;max-width:" + fixed(1.5 * window.width(), 0) + "px\"";
  return "<div class=\"scroll\">" +
         svg_begin(window, attributes, "Side view of the whole crossing") + svg + "</svg></div>\n";
}

std::string draw_jump(const RunRecord& run, const JumpRecord& jump) {
  const Window window = jump_window(run, jump);
  const core::JumpPlan* plan = run.plan_of(jump);
  std::string svg = draw_slabs(run, window) + draw_seen(run, window, plan);
  if (plan != nullptr) svg += draw_target(run, window, *plan);
  for (std::size_t i = 0; i < jump.instants.size(); ++i) {
    if (!std::isfinite(jump.instants[i])) continue;
    svg += draw_figure(window, stick_figure(run.robot, run.moment_at(jump.instants[i]).state),
                       kInstantStyles[i]);
  }
  if (plan != nullptr) svg += path("com planned", window, planned_path(*plan));
  for (const PhaseSpan& span : run.phases) {
    if (span.end <= jump.begin || span.begin >= jump.end) continue;
    svg +=
        path("com flown " + phase_style(span.phase), window, flown_path(run, span.begin, span.end));
  }
  svg += draw_soles(run, window, jump.end) + scale_bar(window);
  const std::string title = "Jump " + std::to_string(jump.index);
  return "<figure><figcaption><b>" + title + "</b></figcaption>" +
         svg_begin(window, "class=\"jump\"", title + " from the side") + svg + "</svg></figure>\n";
}

std::string replay_data(const RunRecord& run) {
  constexpr double kPeriod = 0.02;  // of the figure's frames [s]
  constexpr double kMostFrames = 1500;
  const double last = run.moments.empty() ? 0.0 : run.moments.back().time;
  const double period = std::max(kPeriod, last / kMostFrames);
  const auto add = [](std::string& json, const Vector2d& p) {
    for (const double value : {p.x(), p.y()}) {
      if (!json.empty()) json += ',';
      json += std::isfinite(value) ? fixed(1000.0 * value, 0) : "0";  // whole millimetres
    }
  };
  std::string frames;
  for (double time = 0.0; !run.moments.empty() && time <= last; time += period) {
    const StickFigure figure = stick_figure(run.robot, run.moment_at(time).state);
    std::string frame;
    for (const Vector2d& corner : figure.trunk) add(frame, corner);
    for (const StickFigure::LegPoints& leg : figure.legs) {
      for (const Vector2d& p : {leg.hip, leg.knee, leg.ankle, leg.toe, leg.heel}) add(frame, p);
    }
    frames += (frames.empty() ? "[" : ",[") + frame + "]";
  }
  std::string phases;
  for (const PhaseSpan& span : run.phases) {
    phases += std::string(phases.empty() ? "[" : ",[") + fixed(span.begin, 3) + ",\"" +
              std::string(core::robot_phase_name(span.phase)) + "\"]";
  }
  return "{\"period\":" + fixed(period, 4) + ",\"frames\":[" + frames + "],\"phases\":[" + phases +
         "]}";
}

}  // namespace hopscotch::apps
