#include "apps/html.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>

namespace hopscotch::apps {

std::string escape(std::string_view text) {
  std::string result;
  result.reserve(text.size());
  for (const char c : text) {
    switch (c) {
      case '&': result += "&amp;"; break;
      case '<': result += "&lt;"; break;
      case '>': result += "&gt;"; break;
      case '"': result += "&quot;"; break;
      case '\'': result += "&#39;"; break;
      default:
        // Control characters are not allowed in HTML; line ends and tabs are blanks there anyway.
        result += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
    }
  }
  return result;
}

std::string fixed(double value, int decimals) {
  constexpr double kMost = 1e15;  // beyond it nobody reads digits
  if (!std::isfinite(value) || std::abs(value) > kMost) return "–";
  std::array<char, 40> buffer{};
  const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value,
                                 std::chars_format::fixed, decimals)
                       .ptr;
  std::string text(buffer.data(), end);
  const bool zero = text.find_first_of("123456789") == std::string::npos;
  if (zero && text.front() == '-') text.erase(0, 1);
  return text;
}

std::string path_data(std::span<const Eigen::Vector2d> points) {
  std::string d;
  bool drawing = false;
  for (const Eigen::Vector2d& point : points) {
    if (!point.allFinite()) {
      drawing = false;
      continue;
    }
    d += drawing ? 'L' : 'M';
    d += fixed(point.x(), 1);
    d += ' ';
    d += fixed(point.y(), 1);
    drawing = true;
  }
  return d;
}

std::vector<Eigen::Vector2d> decimate(const std::vector<Eigen::Vector2d>& points,
                                      std::size_t buckets) {
  if (points.size() <= 2 * buckets || buckets == 0) return points;
  std::vector<Eigen::Vector2d> result;
  for (std::size_t bucket = 0; bucket < buckets; ++bucket) {
    const auto begin =
        points.begin() + static_cast<std::ptrdiff_t>(bucket * points.size() / buckets);
    const auto end =
        points.begin() + static_cast<std::ptrdiff_t>((bucket + 1) * points.size() / buckets);
    const auto gap = std::find_if(begin, end, [](const auto& p) { return !p.allFinite(); });
    const auto [low, high] =
        std::minmax_element(begin, gap, [](const auto& a, const auto& b) { return a.y() < b.y(); });
    if (begin != gap) {
      result.push_back(*std::min(low, high));
      if (low != high) result.push_back(*std::max(low, high));
    }
    if (gap != end) {
      result.push_back(*gap);
      const auto rest = std::find_if(gap, end, [](const auto& p) { return p.allFinite(); });
      if (rest != end) result.push_back(*rest);
    }
  }
  return result;
}

std::vector<double> axis_ticks(double lowest, double highest, int most) {
  if (!(highest > lowest) || most < 1) return {};
  const double rough = (highest - lowest) / most;
  const double decade = std::pow(10.0, std::floor(std::log10(rough)));
  double step = 10.0 * decade;
  for (const double nice : {5.0, 2.0, 1.0}) {
    if (nice * decade >= rough * (1.0 - 1e-9)) step = nice * decade;
  }
  std::vector<double> ticks;
  for (double i = std::ceil(lowest / step - 1e-9); i * step <= highest + 1e-9 * step; ++i) {
    ticks.push_back(i * step);
  }
  return ticks;
}

int tick_decimals(const std::vector<double>& ticks) {
  if (ticks.size() < 2) return 0;
  return std::clamp(static_cast<int>(std::ceil(-std::log10(ticks[1] - ticks[0]) - 1e-9)), 0, 6);
}

std::string base64(std::span<const unsigned char> bytes) {
  constexpr std::string_view kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t present = std::min<std::size_t>(3, bytes.size() - i);
    std::uint32_t group = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      group = (group << 8U) | (k < present ? bytes[i + k] : 0U);
    }
    for (std::size_t k = 0; k < 4; ++k) {
      text += k <= present ? kDigits[(group >> (18U - 6U * k)) & 63U] : '=';
    }
  }
  return text;
}

}  // namespace hopscotch::apps
