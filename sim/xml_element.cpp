#include "sim/xml_element.hpp"

#include <limits>
#include <locale>
#include <sstream>

namespace hopscotch::sim {

namespace {

std::string all_digits(const Eigen::Ref<const Eigen::VectorXd>& values) {
  std::ostringstream out;
  out.imbue(std::locale::classic());
  out.precision(std::numeric_limits<double>::max_digits10);
  for (Eigen::Index i = 0; i < values.size(); ++i) out << (i == 0 ? "" : " ") << values(i);
  return out.str();
}

}  // namespace

XmlElement::XmlElement(std::string_view tag) : tag_(tag) {}

XmlElement& XmlElement::with(std::string_view key, std::string_view value) {
  attributes_.append(" ").append(key).append("=\"").append(value).append("\"");
  return *this;
}

XmlElement& XmlElement::with(std::string_view key, const char* value) {
  return with(key, std::string_view(value));
}

XmlElement& XmlElement::with(std::string_view key, double value) {
  return with(key, all_digits(Eigen::Vector<double, 1>(value)));
}

XmlElement& XmlElement::with(std::string_view key, int value) {
  return with(key, std::to_string(value));
}

XmlElement& XmlElement::with(std::string_view key,
                             const Eigen::Ref<const Eigen::VectorXd>& values) {
  return with(key, all_digits(values));
}

XmlElement& XmlElement::with_attributes(std::string_view attributes) {
  attributes_.append(" ").append(attributes);
  return *this;
}

XmlElement& XmlElement::containing(std::string_view children) {
  children_ += children;
  return *this;
}

std::string XmlElement::text() const {
  if (children_.empty()) return "<" + tag_ + attributes_ + "/>\n";
  return "<" + tag_ + attributes_ + ">\n" + children_ + "</" + tag_ + ">\n";
}

}  // namespace hopscotch::sim
