#include "apps/report_chart.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "apps/html.hpp"

namespace hopscotch::apps {

namespace {

constexpr double kLeft = 46.0;  // room for the labels of the y axis
constexpr double kRight = 8.0;
constexpr double kTop = 8.0;
constexpr double kBottom = 30.0;  // room for the labels of the x axis

/// Data to drawing coordinates.
class Plane {
 public:
  Plane(double width, double height, Span x, Span y)
      : x_(x), y_(y), right_(width - kRight), bottom_(height - kBottom) {}

  [[nodiscard]] double left() const { return kLeft; }
  [[nodiscard]] double right() const { return right_; }
  [[nodiscard]] double top() const { return kTop; }
  [[nodiscard]] double bottom() const { return bottom_; }
  [[nodiscard]] double u(double x) const {
    return kLeft + (x - x_.begin) / (x_.end - x_.begin) * (right_ - kLeft);
  }
  [[nodiscard]] double v(double y) const {
    return bottom_ - (y - y_.begin) / (y_.end - y_.begin) * (bottom_ - kTop);
  }
  /// The same, held within the frame.
  [[nodiscard]] double u_inside(double x) const { return std::clamp(u(x), kLeft, right_); }
  [[nodiscard]] double v_inside(double y) const { return std::clamp(v(y), kTop, bottom_); }

 private:
  Span x_;
  Span y_;
  double right_;
  double bottom_;
};

std::string rectangle(const std::string& style, double u0, double v0, double u1, double v1) {
  return "<rect class=\"" + style + "\" x=\"" + fixed(u0, 1) + "\" y=\"" + fixed(v0, 1) +
         "\" width=\"" + fixed(std::max(u1 - u0, 0.0), 1) + "\" height=\"" +
         fixed(std::max(v1 - v0, 0.0), 1) + "\"/>";
}

std::string segment(const std::string& style, double u0, double v0, double u1, double v1) {
  return "<path class=\"" + style + "\" d=\"M" + fixed(u0, 1) + " " + fixed(v0, 1) + "L" +
         fixed(u1, 1) + " " + fixed(v1, 1) + "\"/>";
}

std::string label(const char* anchor, double u, double v, const std::string& text) {
  return std::string("<text text-anchor=\"") + anchor + "\" x=\"" + fixed(u, 1) + "\" y=\"" +
         fixed(v, 1) + "\">" + escape(text) + "</text>";
}

std::string axes(const Plane& plane, const Chart& chart) {
  constexpr double kTickSpacing = 32.0;
  constexpr double kLabelDrop = 13.0;  // baseline of the labels below the axis
  std::string svg;
  const int rows = std::max(2, static_cast<int>((plane.bottom() - plane.top()) / kTickSpacing));
  const std::vector<double> y_ticks = axis_ticks(chart.y.begin, chart.y.end, rows);
  for (const double y : y_ticks) {
    svg += segment(y == 0.0 ? "zero" : "grid", plane.left(), plane.v(y), plane.right(), plane.v(y));
    svg += label("end", plane.left() - 5, plane.v(y) + 4, fixed(y, tick_decimals(y_ticks)));
  }
  const int columns = std::max(2, static_cast<int>((plane.right() - plane.left()) / 60.0));
  const std::vector<double> x_ticks = axis_ticks(chart.x.begin, chart.x.end, columns);
  for (const double x : x_ticks) {
    svg += segment("tick", plane.u(x), plane.bottom(), plane.u(x), plane.bottom() + 3);
    svg +=
        label("middle", plane.u(x), plane.bottom() + kLabelDrop, fixed(x, tick_decimals(x_ticks)));
  }
  svg += segment("axis", plane.left(), plane.bottom(), plane.right(), plane.bottom());
  svg += label("middle", 0.5 * (plane.left() + plane.right()), plane.bottom() + 26, chart.x_label);
  return svg;
}

std::string phase_background(const Plane& plane, const Chart& chart) {
  std::string svg;
  for (const PhaseSpan& span : chart.phases) {
    if (span.end <= chart.x.begin || span.begin >= chart.x.end) continue;
    svg += rectangle(phase_style(span.phase), plane.u_inside(span.begin), plane.top(),
                     plane.u_inside(span.end), plane.bottom());
  }
  return svg;
}

std::string limit_zones(const Plane& plane, const Chart& chart) {
  std::string svg;
  for (const Limit& limit : chart.limits) {
    if (limit.value < chart.y.begin || limit.value > chart.y.end) continue;
    const double v = plane.v_inside(limit.value);
    svg += rectangle("forbidden", plane.left(), limit.upper ? plane.top() : v, plane.right(),
                     limit.upper ? v : plane.bottom());
    svg += segment("limit", plane.left(), v, plane.right(), v);
  }
  return svg;
}

/// Dots closer than a pixel to one another are drawn once.
std::string dots_path(const Plane& plane, const Curve& curve) {
  std::set<std::pair<long, long>> pixels;
  for (const Eigen::Vector2d& point : curve.points) {
    if (!point.allFinite()) continue;
    pixels.emplace(std::lround(plane.u_inside(point.x())), std::lround(plane.v_inside(point.y())));
  }
  std::string d;
  for (const auto& [u, v] : pixels) {
    d.append("M").append(std::to_string(u)).append(" ").append(std::to_string(v)).append("h0");
  }
  return "<path class=\"dots " + curve.style + "\" d=\"" + d + "\"/>";
}

std::string curve_path(const Plane& plane, const Curve& curve) {
  if (curve.mark == Curve::Mark::dots) return dots_path(plane, curve);
  const auto buckets = static_cast<std::size_t>(1.5 * (plane.right() - plane.left()));
  std::vector<Eigen::Vector2d> points = decimate(curve.points, buckets);
  for (Eigen::Vector2d& point : points) {
    if (point.allFinite()) point = {plane.u(point.x()), plane.v_inside(point.y())};
  }
  return "<path class=\"curve " + curve.style + "\" d=\"" + path_data(points) + "\"/>";
}

std::string legend(const Chart& chart) {
  std::string html;
  for (const Curve& curve : chart.curves) {
    if (curve.label.empty()) continue;
    html +=
        "<span class=\"key\"><svg class=\"swatch\" viewBox=\"0 0 22 8\" aria-hidden=\"true\">"
        "<path class=\"curve " +
        curve.style + "\" d=\"M1 4L21 4\"/></svg>" + escape(curve.label) + "</span>";
  }
  return html;
}

std::string figure(const Chart& chart, const std::string& content) {
  return "<figure><figcaption><b>" + escape(chart.title) + "</b> <span class=\"unit\">" +
         escape(chart.unit) + "</span>" + legend(chart) + "</figcaption><svg viewBox=\"0 0 " +
         fixed(chart.width, 0) + " " + fixed(chart.height, 0) + "\" role=\"img\" aria-label=\"" +
         escape(chart.title + " " + chart.unit) + "\">" + content + "</svg></figure>\n";
}

}  // namespace

std::string draw(const Chart& chart) {
  const Plane plane(chart.width, chart.height, chart.x, chart.y);
  std::string svg = phase_background(plane, chart) + limit_zones(plane, chart) + axes(plane, chart);
  for (const Curve& curve : chart.curves) svg += curve_path(plane, curve);
  return figure(chart, svg);
}

Span y_range(const std::vector<Curve>& curves, Span least) {
  Span range = least;
  for (const Curve& curve : curves) {
    for (const Eigen::Vector2d& point : curve.points) {
      if (!point.allFinite()) continue;
      range.begin = std::min(range.begin, point.y());
      range.end = std::max(range.end, point.y());
    }
  }
  constexpr int kSteps = 8;  // so that the rounding costs little room
  const std::vector<double> ticks = axis_ticks(range.begin, range.end, kSteps);
  if (ticks.size() < 2) return range;
  const double step = ticks[1] - ticks[0];
  return {std::floor(range.begin / step) * step, std::ceil(range.end / step) * step};
}

std::string draw_histogram(const std::string& title, const std::vector<TimedWork>& work) {
  Chart chart;
  chart.title = title;
  chart.x_label = "duration [ms]";
  std::vector<double> durations;
  for (const TimedWork& item : work) durations.push_back(item.duration_ms);
  const Percentiles percentiles = Percentiles::of(durations);
  chart.unit = work.empty() ? "none measured"
                            : fixed(percentiles.p50, 2) + " ms median, " +
                                  fixed(percentiles.p99, 2) + " p99, " + fixed(percentiles.max, 2) +
                                  " max, n = " + std::to_string(work.size());
  if (work.empty()) return figure(chart, "");
  constexpr std::size_t kBins = 40;
  chart.x = {0.0, std::max(1.02 * percentiles.max, 1e-3)};
  std::vector<double> counts(kBins, 0.0);
  for (const double duration : durations) {
    const auto bin = static_cast<std::size_t>(duration / chart.x.end * kBins);
    counts[std::min(bin, kBins - 1)] += 1.0;
  }
  chart.y = {0.0, *std::max_element(counts.begin(), counts.end()) * 1.05};
  const Plane plane(chart.width, chart.height, chart.x, chart.y);
  std::string svg = axes(plane, chart);
  for (std::size_t i = 0; i < kBins; ++i) {
    if (counts[i] == 0.0) continue;
    const double width = chart.x.end / kBins;
    svg += rectangle("bar", plane.u(static_cast<double>(i) * width) + 0.5, plane.v(counts[i]),
                     plane.u(static_cast<double>(i + 1) * width) - 0.5, plane.bottom());
  }
  svg += segment("median", plane.u(percentiles.p50), plane.top(), plane.u(percentiles.p50),
                 plane.bottom());
  svg += segment("p99", plane.u(percentiles.p99), plane.top(), plane.u(percentiles.p99),
                 plane.bottom());
  return figure(chart, svg);
}

std::string phase_style(core::RobotPhase phase) {
  return "phase-" + std::string(core::robot_phase_name(phase));
}

}  // namespace hopscotch::apps
