#include "sim/xml_element.hpp"

#include <gtest/gtest.h>

#include <string>

namespace hopscotch::sim {
namespace {

TEST(XmlElement, WithoutChildrenClosesItself) {
  EXPECT_EQ(XmlElement("site").with("name", "imu").with("group", 3).text(),
            "<site name=\"imu\" group=\"3\"/>\n");
}

TEST(XmlElement, HoldsItsChildren) {
  EXPECT_EQ(XmlElement("body").containing(XmlElement("geom").text()).text(),
            "<body>\n<geom/>\n</body>\n");
}

TEST(XmlElement, NumbersKeepAllTheirDigits) {
  const double third = 1.0 / 3.0;
  const std::string text = XmlElement("joint").with("damping", third).text();
  const std::size_t start = text.find('"') + 1;
  EXPECT_EQ(std::stod(text.substr(start, text.rfind('"') - start)), third);
}

TEST(XmlElement, WritesVectorsWithBlanks) {
  EXPECT_EQ(XmlElement("geom").with("pos", Eigen::Vector3d(1.0, -2.5, 0.0)).attributes(),
            " pos=\"1 -2.5 0\"");
}

TEST(XmlElement, TakesOverAttributesOfAnother) {
  const XmlElement source = XmlElement("").with("condim", 3);
  EXPECT_EQ(XmlElement("geom").with_attributes(source.attributes()).text(),
            "<geom  condim=\"3\"/>\n");
}

}  // namespace
}  // namespace hopscotch::sim
