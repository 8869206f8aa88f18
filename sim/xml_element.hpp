#pragma once

#include <Eigen/Core>
#include <string>
#include <string_view>

namespace hopscotch::sim {

/// One XML element, written attribute by attribute. Numbers keep all their digits, so that MuJoCo
/// computes with exactly the parameters of the model.
class XmlElement {
 public:
  explicit XmlElement(std::string_view tag);

  XmlElement& with(std::string_view key, std::string_view value);
  XmlElement& with(std::string_view key, const char* value);
  XmlElement& with(std::string_view key, double value);
  XmlElement& with(std::string_view key, int value);
  XmlElement& with(std::string_view key, const Eigen::Ref<const Eigen::VectorXd>& values);
  /// Adds attributes that are text already.
  XmlElement& with_attributes(std::string_view attributes);
  /// Adds child elements that are text already.
  XmlElement& containing(std::string_view children);

  [[nodiscard]] std::string text() const;
  /// The attributes alone, for `with_attributes` of another element.
  [[nodiscard]] const std::string& attributes() const { return attributes_; }

 private:
  std::string tag_;
  std::string attributes_;
  std::string children_;
};

}  // namespace hopscotch::sim
