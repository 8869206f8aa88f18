#include "apps/option_check.hpp"

#include <charconv>
#include <cmath>
#include <sstream>
#include <string>

namespace hopscotch::apps {

namespace {

template <typename Number>
std::string range_text(Number lowest, Number highest) {
  std::ostringstream text;
  text << "from " << lowest << " to " << highest;
  return text.str();
}

}  // namespace

CLI::Validator finite_number(double lowest, double highest) {
  const bool limited = std::isfinite(lowest) && std::isfinite(highest);
  const std::string range = limited ? range_text(lowest, highest) : "";
  const auto check = [=](const std::string& text) -> std::string {
    double value = 0.0;
    const bool number = CLI::detail::lexical_cast(text, value) && std::isfinite(value);
    if (!number) return text + " is no finite number";
    const bool inside = value >= lowest && value <= highest;
    return inside ? "" : text + " is not " + range;
  };
  return {check, range};
}

CLI::Validator whole_number(std::uint64_t lowest, std::uint64_t highest) {
  const std::string range = range_text(lowest, highest);
  const auto check = [=](const std::string& text) -> std::string {
    std::uint64_t value = 0;
    const char* const end = text.data() + text.size();
    const auto [stopped, error] = std::from_chars(text.data(), end, value);
    const bool octal = text.size() > 1 && text.front() == '0';
    const bool whole = error == std::errc() && stopped == end && !octal;
    const bool inside = whole && value >= lowest && value <= highest;
    return inside ? "" : text + " is no whole number " + range;
  };
  return {check, range};
}

}  // namespace hopscotch::apps
