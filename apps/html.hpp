#pragma once

#include <Eigen/Core>
#include <span>
#include <string>
#include <string_view>
#include <vector>

/// Small pieces of HTML and SVG as text.
namespace hopscotch::apps {

/// Text for use between tags and in attributes.
[[nodiscard]] std::string escape(std::string_view text);

/// A number with so many decimals, for people; an en dash when it is not finite. Independent of the
/// locale.
[[nodiscard]] std::string fixed(double value, int decimals);

/// SVG coordinates of a polyline as the value of a path's `d`, one decimal each; a point that is
/// not finite interrupts the line.
[[nodiscard]] std::string path_data(std::span<const Eigen::Vector2d> points);

/// Keeps what can be seen: per bucket of the first coordinate the lowest and the highest point, so
/// that peaks survive. Points come in the order of their first coordinate; gaps (not finite) stay.
[[nodiscard]] std::vector<Eigen::Vector2d> decimate(const std::vector<Eigen::Vector2d>& points,
                                                    std::size_t buckets);

/// Round numbers to label an axis with: at most `most` of them within [lowest, highest].
[[nodiscard]] std::vector<double> axis_ticks(double lowest, double highest, int most);

/// Decimals that tell neighbouring ticks apart.
[[nodiscard]] int tick_decimals(const std::vector<double>& ticks);

/// Bytes in base 64, for data URIs.
[[nodiscard]] std::string base64(std::span<const unsigned char> bytes);

}  // namespace hopscotch::apps
