#include "apps/campaign/figure.hpp"

#include <algorithm>
#include <cmath>

#include "apps/html.hpp"

namespace hopscotch::apps::campaign {

namespace {

constexpr double kLeft = 52.0;
constexpr double kRight = 12.0;
constexpr double kTop = 38.0;
constexpr double kBottom = 40.0;

constexpr const char* kStyle =
    "<style>.hc text{font:11px system-ui,Arial,sans-serif;fill:#46505c}"
    ".hc .title{font-weight:600;font-size:12px;fill:#1c2430}"
    ".hc .grid{stroke:#e4e8ec;stroke-width:1}.hc .axis{stroke:#8b95a1;stroke-width:1}"
    ".hc .whisker{stroke:#1f5fa8;stroke-width:1.6}.hc .rate{fill:#1f5fa8}"
    ".hc .trend{fill:none;stroke:#1f5fa8;stroke-width:1;opacity:.45}"
    ".hc .path{fill:none;stroke:#1f5fa8;stroke-width:.8;opacity:.3}"
    ".hc .fell{fill:none;stroke:#b3261e;stroke-width:1;opacity:.8}"
    ".hc .box{fill:#cfe0f2;stroke:#1f5fa8}.hc .median{stroke:#1c2430;stroke-width:2.4}"
    ".hc .bar{fill:#b3261e;opacity:.75}</style>";

std::string svg(double width, double height, const std::string& content) {
  return "<svg class=\"hc\" xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 " + fixed(width, 0) +
         " " + fixed(height, 0) + "\" width=\"" + fixed(width, 0) + "\" height=\"" +
         fixed(height, 0) + "\" role=\"img\">" + kStyle + content + "</svg>\n";
}

std::string line(const char* style, double u0, double v0, double u1, double v1) {
  return std::string("<line class=\"") + style + "\" x1=\"" + fixed(u0, 1) + "\" y1=\"" +
         fixed(v0, 1) + "\" x2=\"" + fixed(u1, 1) + "\" y2=\"" + fixed(v1, 1) + "\"/>";
}

std::string text(const char* anchor, double u, double v, const std::string& words) {
  return std::string("<text text-anchor=\"") + anchor + "\" x=\"" + fixed(u, 1) + "\" y=\"" +
         fixed(v, 1) + "\">" + escape(words) + "</text>";
}

std::string title(const std::string& words) {
  return "<text class=\"title\" x=\"" + fixed(kLeft, 0) + "\" y=\"15\">" + escape(words) +
         "</text>";
}

/// Data to drawing.
struct Plane {
  double width;
  double height;
  double x0;
  double x1;
  double y0;
  double y1;
  [[nodiscard]] double u(double x) const {
    return kLeft + (x - x0) / (x1 - x0) * (width - kLeft - kRight);
  }
  [[nodiscard]] double v(double y) const {
    return height - kBottom - (y - y0) / (y1 - y0) * (height - kTop - kBottom);
  }
};

std::string axes(const Plane& plane, const std::string& x_label, const std::string& y_label) {
  std::string content;
  const std::vector<double> ys = axis_ticks(plane.y0, plane.y1, 6);
  for (const double y : ys) {
    content += line("grid", kLeft, plane.v(y), plane.width - kRight, plane.v(y));
    content += text("end", kLeft - 5.0, plane.v(y) + 4.0, fixed(y, tick_decimals(ys)));
  }
  const std::vector<double> xs = axis_ticks(plane.x0, plane.x1, 7);
  for (const double x : xs) {
    content +=
        line("axis", plane.u(x), plane.height - kBottom, plane.u(x), plane.height - kBottom + 4.0);
    content +=
        text("middle", plane.u(x), plane.height - kBottom + 16.0, fixed(x, tick_decimals(xs)));
  }
  content +=
      line("axis", kLeft, plane.height - kBottom, plane.width - kRight, plane.height - kBottom);
  content += text("middle", 0.5 * (kLeft + plane.width - kRight), plane.height - 6.0, x_label);
  return content + text("start", 4.0, kTop - 10.0, y_label);
}

/// Blue for always, white for half, red for never.
std::string rate_colour(double rate) {
  const double toward = 2.0 * std::abs(rate - 0.5);
  const bool good = rate >= 0.5;
  const auto mix = [&](double end) { return std::lround(255.0 + toward * (end - 255.0)); };
  return "rgb(" + std::to_string(mix(good ? 66.0 : 196.0)) + "," +
         std::to_string(mix(good ? 133.0 : 62.0)) + "," + std::to_string(mix(good ? 196.0 : 52.0)) +
         ")";
}

std::string percent(double share) {
  return fixed(100.0 * share, 0) + " %";
}

/// Where a bin stands: the middle of its numbers, or its place among the words.
double centre_of(const Factor& factor, const std::vector<FactorBin>& bins, std::size_t i) {
  if (factor.words) return static_cast<double>(i);
  return 0.5 * (bins[i].low + bins[i].high);
}

std::string word_labels(const Factor& factor, const std::vector<FactorBin>& bins,
                        const Plane& plane) {
  std::string content;
  for (std::size_t i = 0; i < bins.size(); ++i) {
    const auto level = std::find(factor.values.begin(), factor.values.end(), bins[i].low);
    content += text("middle", plane.u(static_cast<double>(i)), plane.height - kBottom + 16.0,
                    factor.labels[static_cast<std::size_t>(level - factor.values.begin())]);
  }
  return content;
}

}  // namespace

std::string factor_figure(const Factor& factor, const std::vector<FactorBin>& bins) {
  constexpr double kWidth = 360.0;
  constexpr double kHeight = 220.0;
  if (bins.empty()) return "";
  const double first = centre_of(factor, bins, 0);
  const double last = centre_of(factor, bins, bins.size() - 1);
  const double room = std::max(0.08 * (last - first), 1e-6) + (factor.words ? 0.4 : 0.0);
  const Plane plane{kWidth, kHeight, first - room, last + room, 0.0, 100.0};
  std::string content = title("Success against " + factor.name);
  if (factor.words) {
    content += word_labels(factor, bins, plane);
    content += line("axis", kLeft, plane.v(0.0), kWidth - kRight, plane.v(0.0));
    for (const double y : {0.0, 50.0, 100.0}) {
      content += text("end", kLeft - 5.0, plane.v(y) + 4.0, fixed(y, 0));
    }
    content += text("start", 4.0, kTop - 10.0, "%");
  } else {
    content += axes(plane, factor.name, "%");
  }
  std::vector<Eigen::Vector2d> trend;
  for (std::size_t i = 0; i < bins.size(); ++i) {
    const double u = plane.u(centre_of(factor, bins, i));
    const Interval interval = bins[i].tally.interval();
    const double v = plane.v(100.0 * bins[i].tally.rate());
    content += line("whisker", u, plane.v(100.0 * interval.low), u, plane.v(100.0 * interval.high));
    content += "<circle class=\"rate\" r=\"3\" cx=\"" + fixed(u, 1) + "\" cy=\"" + fixed(v, 1) +
               "\"><title>" + std::to_string(bins[i].tally.succeeded) + " of " +
               std::to_string(bins[i].tally.trials) + "</title></circle>";
    trend.emplace_back(u, v);
  }
  if (!factor.words) content += "<path class=\"trend\" d=\"" + path_data(trend) + "\"/>";
  return svg(kWidth, kHeight, content);
}

std::string heat_map(const Analysis& analysis, std::size_t across, std::size_t up) {
  constexpr double kCell = 46.0;
  constexpr double kLabels = 76.0;
  const Factor& x = analysis.identity.factors[across];
  const Factor& y = analysis.identity.factors[up];
  std::vector<Tally> sums(x.levels() * y.levels());
  for (const CellSummary& cell : analysis.cells) {
    Tally& sum = sums[cell.levels[up] * x.levels() + cell.levels[across]];
    sum.trials += cell.tally.trials;
    sum.succeeded += cell.tally.succeeded;
  }
  const double height = kTop + kCell * static_cast<double>(y.levels()) + kBottom;
  std::string content = title(x.name + " by " + y.name + ": success");
  for (std::size_t j = 0; j < y.levels(); ++j) {
    const double v = height - kBottom - kCell * static_cast<double>(j + 1);
    content += text("end", kLabels - 6.0, v + 0.5 * kCell + 4.0, level_label(y, j));
    for (std::size_t i = 0; i < x.levels(); ++i) {
      const Tally& sum = sums[j * x.levels() + i];
      const double u = kLabels + kCell * static_cast<double>(i);
      const std::string fill = sum.trials > 0 ? rate_colour(sum.rate()) : "#e4e8ec";
      content += "<rect x=\"" + fixed(u, 1) + "\" y=\"" + fixed(v, 1) + "\" width=\"" +
                 fixed(kCell - 1.0, 1) + "\" height=\"" + fixed(kCell - 1.0, 1) + "\" fill=\"" +
                 fill + "\"><title>" + std::to_string(sum.succeeded) + " of " +
                 std::to_string(sum.trials) + "</title></rect>";
      content += text("middle", u + 0.5 * kCell, v + 0.5 * kCell + 4.0,
                      sum.trials > 0 ? percent(sum.rate()) : "");
    }
  }
  for (std::size_t i = 0; i < x.levels(); ++i) {
    content += text("middle", kLabels + kCell * (static_cast<double>(i) + 0.5),
                    height - kBottom + 14.0, level_label(x, i));
  }
  const double width = kLabels + kCell * static_cast<double>(x.levels()) + kRight;
  content += text("middle", 0.5 * (kLabels + width), height - 8.0, x.name);
  return svg(std::max(width, 260.0), height, content);
}

std::string path_figure(const std::string& heading, const std::vector<FlownPath>& paths) {
  constexpr double kWidth = 760.0;
  Plane plane{kWidth, 0.0, 1e9, -1e9, 1e9, -1e9};
  for (const FlownPath& path : paths) {
    for (const auto& [x, z] : path.points) {
      plane.x0 = std::min(plane.x0, 1e-3 * x);
      plane.x1 = std::max(plane.x1, 1e-3 * x);
      plane.y0 = std::min(plane.y0, 1e-3 * z);
      plane.y1 = std::max(plane.y1, 1e-3 * z);
    }
  }
  if (plane.x0 > plane.x1) return "";
  constexpr double kRoom = 0.03;  // [m]
  plane.x0 -= kRoom;
  plane.x1 += kRoom;
  plane.y0 -= kRoom;
  plane.y1 += kRoom;
  const double scale = (kWidth - kLeft - kRight) / (plane.x1 - plane.x0);
  plane.height = kTop + kBottom + scale * (plane.y1 - plane.y0);
  std::string good;
  std::string bad;
  for (const FlownPath& path : paths) {
    std::vector<Eigen::Vector2d> points;
    for (const auto& [x, z] : path.points) {
      points.emplace_back(plane.u(1e-3 * x), plane.v(1e-3 * z));
    }
    std::string& side = path.succeeded ? good : bad;
    side += std::string("<path class=\"") + (path.succeeded ? "path" : "fell") + "\" d=\"" +
            path_data(points) + "\"/>";
  }
  return svg(kWidth, plane.height, title(heading) + axes(plane, "x [m]", "CoM z [m]") + good + bad);
}

std::string spread_figure(const std::string& heading, const std::vector<NamedSpread>& spreads) {
  constexpr double kWidth = 620.0;
  constexpr double kRow = 30.0;
  constexpr double kNames = 210.0;
  constexpr double kHalfBox = 7.0;
  double most = 0.0;
  for (const auto& [name, spread] : spreads) most = std::max(most, spread.p95);  // NaN: not larger
  if (most <= 0.0) return "";
  const double bottom = kTop + kRow * static_cast<double>(spreads.size());
  const auto u = [&](double x) { return kNames + x / (1.05 * most) * (kWidth - kNames - kRight); };
  std::string content = title(heading);
  const std::vector<double> ticks = axis_ticks(0.0, 1.05 * most, 7);
  for (const double x : ticks) {
    content += line("grid", u(x), kTop, u(x), bottom);
    content += text("middle", u(x), bottom + 16.0, fixed(x, tick_decimals(ticks)));
  }
  double v = kTop + 0.5 * kRow;
  for (const auto& [name, spread] : spreads) {
    content += text("end", kNames - 8.0, v + 4.0, name);
    if (!std::isnan(spread.p50)) {
      content += line("whisker", u(spread.p5), v, u(spread.p95), v);
      content += "<rect class=\"box\" x=\"" + fixed(u(spread.p25), 1) + "\" y=\"" +
                 fixed(v - kHalfBox, 1) + "\" width=\"" + fixed(u(spread.p75) - u(spread.p25), 1) +
                 "\" height=\"" + fixed(2.0 * kHalfBox, 1) + "\"/>";
      content += line("median", u(spread.p50), v - kHalfBox, u(spread.p50), v + kHalfBox);
    }
    v += kRow;
  }
  return svg(kWidth, bottom + 40.0,
             content + text("middle", 0.5 * (kNames + kWidth), bottom + 34.0,
                            "line: 5 to 95 % of the trials, box: 25 to 75 %, mark: median"));
}

std::string failure_figure(const Analysis& analysis) {
  constexpr double kWidth = 520.0;
  constexpr double kRow = 22.0;
  constexpr double kNames = 150.0;
  if (analysis.failures.empty()) return "";
  const auto most = static_cast<double>(analysis.failures.front().count);
  std::string content = title("Failures by first cause");
  double v = kTop + 6.0;
  for (const FailureClass& failure : analysis.failures) {
    const double length =
        (kWidth - kNames - 60.0) * static_cast<double>(failure.count) / std::max(most, 1.0);
    content += text("end", kNames - 6.0, v + 14.0, failure.cause);
    content += "<rect class=\"bar\" x=\"" + fixed(kNames, 1) + "\" y=\"" + fixed(v + 3.0, 1) +
               "\" width=\"" + fixed(length, 1) + "\" height=\"" + fixed(kRow - 6.0, 1) + "\"/>";
    content += text("start", kNames + length + 5.0, v + 14.0, std::to_string(failure.count));
    v += kRow;
  }
  return svg(kWidth, v + 10.0, content);
}

}  // namespace hopscotch::apps::campaign
