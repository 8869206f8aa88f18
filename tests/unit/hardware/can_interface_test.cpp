#include "hardware/can_interface.hpp"

#include <gtest/gtest.h>

namespace hopscotch::hardware {
namespace {

TEST(CanInterfaces, OnlyAVirtualOneThatIsThereIsVirtual) {
  std::vector<CanInterface> interfaces(2);
  interfaces[0].name = "can0";
  interfaces[0].kind = "vcan";
  interfaces[1].name = "can1";
  interfaces[1].kind = "can";
  EXPECT_TRUE(is_virtual(interfaces, "can0"));
  EXPECT_FALSE(is_virtual(interfaces, "can1"));
  EXPECT_FALSE(is_virtual(interfaces, "can2"));
}

}  // namespace
}  // namespace hopscotch::hardware
