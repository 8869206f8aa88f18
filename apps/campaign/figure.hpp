#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "apps/campaign/analysis.hpp"

/// Figures as SVG that stands alone (for papers) and within a page alike.
namespace hopscotch::apps::campaign {

/// Success rate with 95 % intervals against one factor.
[[nodiscard]] std::string factor_figure(const Factor& factor, const std::vector<FactorBin>& bins);

/// Success rate over the levels of two grid factors, all other factors taken together; the first
/// runs to the right, the second up.
/// @pre both are grids; `across` != `up`
[[nodiscard]] std::string heat_map(const Analysis& analysis, std::size_t across, std::size_t up);

/// The CoM of one trial, x and z in W [mm].
struct FlownPath {
  std::vector<std::array<std::int16_t, 2>> points;
  bool succeeded = true;
};
/// The paths of many trials over one another, to scale; failures on top, in red.
[[nodiscard]] std::string path_figure(const std::string& title,
                                      const std::vector<FlownPath>& paths);

/// What the trials of a cell spread over.
struct NamedSpread {
  std::string name;
  Quantiles spread;
};
/// One row a spread: a line from 5 to 95 %, a box from 25 to 75 %, a mark at the median. Empty if
/// there is no number at all.
[[nodiscard]] std::string spread_figure(const std::string& heading,
                                        const std::vector<NamedSpread>& spreads);

/// Failure classes as bars.
[[nodiscard]] std::string failure_figure(const Analysis& analysis);

}  // namespace hopscotch::apps::campaign
