#pragma once

#include <optional>
#include <string>
#include <vector>

#include "apps/campaign/analysis.hpp"
#include "apps/campaign/campaign.hpp"
#include "apps/campaign/comparison.hpp"
#include "apps/campaign/figure.hpp"

namespace hopscotch::apps::campaign {

/// A figure and the name of its file.
struct NamedFigure {
  std::string name;
  std::string svg;
};

/// All figures of a campaign: success against each factor that varies, heat maps of pairs of
/// grids, failure classes, and the CoM paths of the first cells.
[[nodiscard]] std::vector<NamedFigure> campaign_figures(const Analysis& analysis,
                                                        const Store& store);

/// What the page shows.
struct ReportContent {
  CampaignFolder folder;
  const Analysis& analysis;
  std::vector<NamedFigure> figures;
  std::optional<Comparison> comparison;
};
/// The report as one self-contained page.
[[nodiscard]] std::string report_page(const ReportContent& content);

/// One line a trial: index, cell, factors, outcome, metrics; nothing that depends on the machine,
/// so that equal campaigns give equal bytes.
[[nodiscard]] std::string trials_csv(const Store& store);
/// One line a cell.
[[nodiscard]] std::string cells_csv(const Analysis& analysis);

}  // namespace hopscotch::apps::campaign
