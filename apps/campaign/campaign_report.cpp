#include "apps/campaign/campaign_report.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "apps/html.hpp"
#include "apps/report_style.hpp"

namespace hopscotch::apps::campaign {

namespace {

constexpr std::size_t kCellsShown = 300;
constexpr std::size_t kPathCells = 4;
constexpr std::size_t kHeatMaps = 6;
constexpr std::size_t kHeatLevels = 25;
constexpr std::size_t kSpreadCells = 16;

constexpr const char* kTableStyle =
    "table{border-collapse:collapse;font-size:.9rem;font-variant-numeric:tabular-nums}"
    "th,td{padding:.25em .8em;text-align:right;border-bottom:1px solid var(--line)}"
    "th:first-child,td:first-child,.words{text-align:left}"
    "code{font-size:.85em}svg.hc{width:auto;max-width:100%;height:auto}"
    ".figures{display:flex;flex-wrap:wrap;gap:14px 22px}";

std::string percent(double share) {
  return fixed(100.0 * share, 1) + " %";
}

std::string interval_text(const Tally& tally) {
  const Interval interval = tally.interval();
  return fixed(100.0 * interval.low, 1) + " to " + fixed(100.0 * interval.high, 1) + " %";
}

/// Text whose line ends stay, for preformatted blocks.
std::string escape_lines(const std::string& text) {
  std::string result;
  std::size_t begin = 0;
  while (begin <= text.size()) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    result += escape(text.substr(begin, end - begin)) + "\n";
    begin = end + 1;
  }
  return result;
}

std::string cell_of(const std::string& content) {
  return "<td>" + content + "</td>";
}

std::string words_of(const std::string& content) {
  return "<td class=\"words\">" + content + "</td>";
}

std::string section(const std::string& heading, const std::string& lead,
                    const std::string& content) {
  if (content.empty()) return "";
  return "<section><h2>" + heading + "</h2><p class=\"lead\">" + lead + "</p><div class=\"card\">" +
         content + "</div></section>\n";
}

std::string table(const std::string& head, const std::string& rows) {
  return rows.empty()
             ? ""
             : "<div class=\"scroll\"><table><tr>" + head + "</tr>" + rows + "</table></div>";
}

std::string command_of(const ReportContent& content, std::int64_t index) {
  return "hopscotch campaign SPEC --out " + content.folder.path.string() + " --trial " +
         std::to_string(index);
}

/// A link to the run folder of a trial if it is there, else the command that makes it.
std::string trial_link(const ReportContent& content, std::int64_t index) {
  const std::string name = "trial " + std::to_string(index);
  const std::filesystem::path page = content.folder.run(index) / "report.html";
  if (std::filesystem::exists(page)) {
    return "<a href=\"runs/" + escape(content.folder.run(index).filename().string()) +
           "/report.html\">" + name + "</a>";
  }
  return "<code>--trial " + std::to_string(index) + "</code>";
}

std::string tile(const std::string& figure, const std::string& words) {
  return "<div class=\"tile\"><b>" + figure + "</b><span>" + words + "</span></div>";
}

std::string opening(const ReportContent& content) {
  const Analysis& analysis = content.analysis;
  const Tally& total = analysis.total;
  return "<header><h1>" + escape(analysis.identity.name) + ": " + std::to_string(total.succeeded) +
         " of " + std::to_string(total.trials) +
         " trials succeeded</h1><p class=\"lead\">Program " + escape(analysis.identity.program) +
         ", engine " + escape(analysis.engine) + ", identity " +
         escape(analysis.identity.identity) +
         ". A trial succeeds when its run is completed, or refused where the same seed with true "
         "terrain is refused too. Intervals are 95 % score intervals of Wilson. SPEC in the "
         "commands is the campaign file.</p></header><div class=\"tiles\">" +
         tile(percent(total.rate()), "succeeded, " + interval_text(total)) +
         tile(std::to_string(total.trials), "trials") +
         tile(std::to_string(analysis.rightly_refused), "of them rightly refused") +
         tile(std::to_string(total.trials - total.succeeded), "failed") +
         tile(fixed(analysis.trials_per_minute(), 0), "trials a minute") + "</div>\n";
}

std::string degrees(double angle) {
  return fixed(180.0 / std::numbers::pi * angle, 1);
}

std::string cell_row(const Analysis& analysis, const CellSummary& cell) {
  std::string row = "<tr>";
  for (std::size_t f = 0; f < analysis.identity.factors.size(); ++f) {
    const Factor& factor = analysis.identity.factors[f];
    if (factor.kind == Factor::Kind::grid) {
      row += words_of(escape(level_label(factor, cell.levels[f])));
    }
  }
  const auto spread = [](const Moments& moments) {
    return fixed(1e3 * moments.mean(), 0) + " ± " + fixed(1e3 * moments.deviation(), 1);
  };
  return row + cell_of(std::to_string(cell.tally.trials)) +
         cell_of(std::to_string(cell.tally.succeeded)) +
         cell_of(std::to_string(cell.rightly_refused)) + cell_of(percent(cell.tally.rate())) +
         cell_of(interval_text(cell.tally)) + cell_of(spread(cell.distance)) +
         cell_of(spread(cell.landing_error)) + cell_of(spread(cell.support_margin)) +
         cell_of(degrees(cell.pitch_error.p50) + ", " + degrees(cell.pitch_error.p95)) +
         cell_of(fixed(cell.jump_time.mean(), 3) + ", " + fixed(cell.jump_time_p95.mean(), 3)) +
         "</tr>";
}

std::string cells_section(const Analysis& analysis) {
  std::string head;
  for (const Factor& factor : analysis.identity.factors) {
    if (factor.kind == Factor::Kind::grid)
      head += "<th class=\"words\">" + escape(factor.name) + "</th>";
  }
  head +=
      "<th>trials</th><th>succeeded</th><th>rightly refused</th><th>rate</th><th>95 %</th><th>last "
      "jump [mm]</th>"
      "<th>landing error [mm]</th><th>margin [mm]</th><th>pitch error [°]</th>"
      "<th>time a jump [s]</th>";
  std::string rows;
  for (std::size_t i = 0; i < analysis.cells.size() && i < kCellsShown; ++i) {
    rows += cell_row(analysis, analysis.cells[i]);
  }
  std::string lead =
      "Mean ± standard deviation over the trials of a cell. Pitch error: the trunk's beside the "
      "plan's, largest in the 150 ms after a touchdown; median and 95 % of the trials. Time from "
      "the "
      "start of a jump to the next one's: mean and 95 %.";
  if (analysis.cells.size() > kCellsShown) {
    lead += " The first " + std::to_string(kCellsShown) + "; all are in cells.csv.";
  }
  return section("Cells", lead, table(head, rows));
}

std::string factors_section(const Analysis& analysis) {
  std::string rows;
  if (analysis.failures.empty()) return "";  // nothing to explain
  for (const Explanation& explanation : analysis.explanations) {
    rows += "<tr>" + words_of(escape(explanation.factor)) + cell_of(percent(explanation.share)) +
            cell_of(explanation.p_value < 1e-4 ? "&lt; 0.0001" : fixed(explanation.p_value, 4)) +
            "</tr>";
  }
  return section("What explains the failures",
                 "Share of the outcome's variance that lies between the values of a factor, "
                 "corrected for chance (ω²), and the p-value of a χ² test of independence. Factors "
                 "that interact share what they explain.",
                 table("<th>factor</th><th>share</th><th>p</th>", rows));
}

std::string failures_section(const ReportContent& content) {
  std::string rows;
  for (const FailureClass& failure : content.analysis.failures) {
    std::string links;
    for (const std::int64_t index : failure.examples) links += trial_link(content, index) + " ";
    rows += "<tr>" + words_of(escape(failure.cause)) + cell_of(std::to_string(failure.count)) +
            words_of(escape(failure.sentence)) + words_of(links) +
            words_of("<code>" + escape(command_of(content, failure.examples.front())) + "</code>") +
            "</tr>";
  }
  return section("Failures",
                 "By the first thing that went wrong; the sentence is the first example's.",
                 table("<th>cause</th><th>trials</th><th class=\"words\">for instance</th>"
                       "<th class=\"words\">examples</th><th class=\"words\">run it again</th>",
                       rows));
}

std::string close_calls_section(const ReportContent& content) {
  std::string rows;
  for (const CloseCall& call : content.analysis.close_calls) {
    rows += "<tr>" + words_of(trial_link(content, call.index)) +
            cell_of(fixed(1e3 * call.support_margin, 0)) +
            cell_of(fixed(1e3 * call.landing_error, 0)) + "</tr>";
  }
  return section("Worst of the successes", "Least ground left beyond toe or heel at rest.",
                 table("<th>trial</th><th>margin [mm]</th><th>landing error [mm]</th>", rows));
}

std::string comparison_row(const std::string& name, const PairedCounts& counts) {
  const PairedDifference result = compare_paired(counts);
  return "<tr>" + words_of(escape(name)) + cell_of(std::to_string(counts.total())) +
         cell_of(std::to_string(counts.only_a)) + cell_of(std::to_string(counts.only_b)) +
         cell_of(fixed(100.0 * result.difference, 1)) +
         cell_of(fixed(100.0 * result.interval95.low, 1) + " to " +
                 fixed(100.0 * result.interval95.high, 1)) +
         cell_of(result.p_value < 1e-4 ? "&lt; 0.0001" : fixed(result.p_value, 4)) + "</tr>";
}

std::string comparison_section(const ReportContent& content) {
  if (!content.comparison) return "";
  const Comparison& comparison = *content.comparison;
  const std::vector<Factor>& factors = content.analysis.identity.factors;
  std::string rows = comparison_row("all cells", comparison.total);
  for (std::size_t i = 0;
       comparison.cells.size() > 1 && i < comparison.cells.size() && i < kCellsShown; ++i) {
    const std::vector<std::size_t> levels = levels_of(factors, static_cast<std::int64_t>(i));
    std::string name;
    for (std::size_t f = 0; f < factors.size(); ++f) {
      if (factors[f].kind != Factor::Kind::grid) continue;
      name += factors[f].name + " = " + level_label(factors[f], levels[f]) + " ";
    }
    rows += comparison_row(name, comparison.cells[i]);
  }
  return section("“" + escape(comparison.name_a) + "” against “" + escape(comparison.name_b) + "”",
                 "The same draws in both, trial by trial; second program " +
                     escape(comparison.program_b) +
                     ". Difference of the rates in percent points with its 95 % interval "
                     "(Newcombe, paired) and the p-value of McNemar's exact test.",
                 table("<th>cell</th><th>pairs</th><th>only first</th><th>only second</th>"
                       "<th>difference</th><th>95 %</th><th>p</th>",
                       rows));
}

std::string figures_section(const std::vector<NamedFigure>& figures) {
  std::string content;
  for (const NamedFigure& figure : figures) content += "<figure>" + figure.svg + "</figure>";
  if (content.empty()) return "";
  return section("Figures",
                 "Each is a file of its own in <a href=\"figures\">figures/</a>. Bars: 95 %.",
                 "<div class=\"figures\">" + content + "</div>");
}

void add_heat_maps(const Analysis& analysis, std::vector<NamedFigure>& figures) {
  const std::vector<Factor>& factors = analysis.identity.factors;
  std::size_t count = 0;
  const auto fits = [](const Factor& factor) {
    return factor.levels() > 1 && factor.levels() <= kHeatLevels;
  };
  for (std::size_t up = 0; up < factors.size(); ++up) {
    for (std::size_t across = up + 1; across < factors.size() && count < kHeatMaps; ++across) {
      if (!fits(factors[up]) || !fits(factors[across])) continue;
      figures.push_back(
          {"map-" + factors[up].name + "-" + factors[across].name, heat_map(analysis, across, up)});
      ++count;
    }
  }
}

std::string cell_title(const Analysis& analysis, std::size_t cell) {
  std::string name;
  const std::vector<Factor>& factors = analysis.identity.factors;
  for (std::size_t f = 0; f < factors.size(); ++f) {
    if (factors[f].kind != Factor::Kind::grid) continue;
    name += (name.empty() ? "" : ", ") + factors[f].name + " = " +
            level_label(factors[f], analysis.cells[cell].levels[f]);
  }
  return name;
}

/// The cells side by side where few enough are compared.
void add_pitch_errors(const Analysis& analysis, std::vector<NamedFigure>& figures) {
  if (analysis.cells.size() < 2 || analysis.cells.size() > kSpreadCells) return;
  std::vector<NamedSpread> spreads;
  for (std::size_t cell = 0; cell < analysis.cells.size(); ++cell) {
    Quantiles spread = analysis.cells[cell].pitch_error;
    for (double* value : {&spread.p5, &spread.p25, &spread.p50, &spread.p75, &spread.p95}) {
      *value *= 180.0 / std::numbers::pi;
    }
    spreads.push_back({cell_title(analysis, cell), spread});
  }
  const std::string drawn = spread_figure("Pitch error in the 150 ms after touchdown [°]", spreads);
  if (!drawn.empty()) figures.push_back({"pitch-error", drawn});
}

void add_paths(const Analysis& analysis, const Store& store, std::vector<NamedFigure>& figures) {
  std::vector<std::vector<FlownPath>> paths(std::min(kPathCells, analysis.cells.size()));
  store.for_each_path(static_cast<std::int64_t>(paths.size()), [&](const TrialResult& trial) {
    const TrialPlace place = place_of(trial.index, analysis.identity.cells);
    paths[static_cast<std::size_t>(place.cell)].push_back({trial.path, trial.succeeded()});
  });
  for (std::size_t cell = 0; cell < paths.size(); ++cell) {
    const std::string heading = "CoM of " + std::to_string(paths[cell].size()) + " trials";
    const std::string name = cell_title(analysis, cell);
    const std::string drawn = path_figure(heading + (name.empty() ? "" : ": " + name), paths[cell]);
    if (!drawn.empty()) figures.push_back({"com-paths-" + std::to_string(cell), drawn});
  }
}

}  // namespace

std::vector<NamedFigure> campaign_figures(const Analysis& analysis, const Store& store) {
  std::vector<NamedFigure> figures;
  add_paths(analysis, store, figures);
  for (std::size_t i = 0; i < analysis.bins.size(); ++i) {
    const Factor& factor = analysis.identity.factors[i];
    const std::string drawn = factor_figure(factor, analysis.bins[i]);
    if (!drawn.empty()) figures.push_back({"success-" + factor.name, drawn});
  }
  add_heat_maps(analysis, figures);
  add_pitch_errors(analysis, figures);
  const std::string failures = failure_figure(analysis);
  if (!failures.empty()) figures.push_back({"failures", failures});
  return figures;
}

std::string report_page(const ReportContent& content) {
  return "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">"
         "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">"
         "<link rel=\"icon\" href=\"data:,\"><title>" +
         escape(content.analysis.identity.name) + "</title><style>" + std::string(kReportStyle) +
         kTableStyle + "</style></head>\n<body><main>\n" + opening(content) +
         comparison_section(content) + cells_section(content.analysis) + failures_section(content) +
         factors_section(content.analysis) + figures_section(content.figures) +
         close_calls_section(content) +
         section("Files", "Beside this page.",
                 "<ul><li><a href=\"trials.csv\">trials.csv</a> every trial</li>"
                 "<li><a href=\"cells.csv\">cells.csv</a> every cell</li>"
                 "<li><a href=\"summary.json\">summary.json</a> the figures for programs</li>"
                 "<li><a href=\"trials.sqlite\">trials.sqlite</a> the store</li></ul>") +
         "<details><summary>The campaign file</summary><pre>" +
         escape_lines(content.analysis.identity.source) + "</pre></details></main></body></html>\n";
}

}  // namespace hopscotch::apps::campaign
