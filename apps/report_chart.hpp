#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "apps/report_data.hpp"

namespace hopscotch::apps {

/// A line in a chart; `style` is a CSS class of the report.
struct Curve {
  std::string style;
  std::string label;
  std::vector<Eigen::Vector2d> points;  ///< In data units; not finite = gap.
  enum class Mark { line, dots } mark = Mark::line;
};

/// A limit of the vertical quantity: the zone beyond it is shaded.
struct Limit {
  double value = 0.0;
  bool upper = true;  ///< The forbidden zone lies above.
};

struct Span {
  double begin = 0.0;
  double end = 1.0;
};

/// One diagram.
struct Chart {
  std::string title;
  std::string unit;      ///< Of the vertical axis.
  double width = 340.0;  ///< Of the drawing [user units, about pixels].
  double height = 170.0;
  Span x;  ///< Shown range.
  Span y;
  std::string x_label = "time [s]";
  std::vector<Curve> curves;
  std::vector<Limit> limits;
  std::vector<PhaseSpan> phases;  ///< As tinted background; empty: none.
};

/// The chart as one `<figure>` with inline SVG, its title as caption and text alternative.
[[nodiscard]] std::string draw(const Chart& chart);

/// Range of all finite y of the curves, widened to round numbers; at least `least`.
[[nodiscard]] Span y_range(const std::vector<Curve>& curves, Span least);

/// A histogram of durations with median and 99th percentile.
[[nodiscard]] std::string draw_histogram(const std::string& title,
                                         const std::vector<TimedWork>& work);

/// CSS class of a phase.
[[nodiscard]] std::string phase_style(core::RobotPhase phase);

}  // namespace hopscotch::apps
