#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>

namespace hopscotch {

/// A test with an empty folder of its own, gone afterwards: ctest runs tests side by side.
class FolderTest : public ::testing::Test {
 protected:
  FolderTest() {
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
  }
  ~FolderTest() override { std::filesystem::remove_all(folder_); }

  const std::filesystem::path folder_ = std::filesystem::path(::testing::TempDir()) / name();

 private:
  static std::string name() {
    const ::testing::TestInfo& test = *::testing::UnitTest::GetInstance()->current_test_info();
    std::string name = std::string("hopscotch-") + test.test_suite_name() + "-" + test.name();
    std::replace(name.begin(), name.end(), '/', '-');  // of parameters
    return name;
  }
};

}  // namespace hopscotch
