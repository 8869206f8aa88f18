#include "core/input_file.hpp"
#include "tests/folder_test.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

namespace hopscotch::core {
namespace {

namespace fs = std::filesystem;

std::string complaint(const fs::path& file, std::uintmax_t size_max = 1024) {
  try {
    (void)read_input_file(file, size_max);
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "";
}

class InputFile : public FolderTest {
 protected:
  fs::path write(const std::string& bytes) {
    std::ofstream(folder_ / "file", std::ios::binary) << bytes;
    return folder_ / "file";
  }
};

TEST_F(InputFile, IsReadToTheLastByte) {
  const std::string bytes(200'001, '\0');
  EXPECT_EQ(read_input_file(write(bytes)), bytes);
}

TEST_F(InputFile, ThatIsEmptyIsNoError) {
  EXPECT_EQ(read_input_file(write("")), "");
}

TEST_F(InputFile, ThatIsNoneIsRefusedWithTheReason) {
  EXPECT_EQ(complaint(folder_ / "none"), (folder_ / "none").string() + ": no such file");
  EXPECT_EQ(complaint(folder_), folder_.string() + ": is no regular file");
  EXPECT_EQ(complaint("/dev/null"), "/dev/null: is no regular file");
  const fs::path large = write(std::string((1U << 20U) + 1, 'a'));
  EXPECT_EQ(complaint(large, 1), large.string() + ": is larger than 1 MiB");
}

class PlainName : public ::testing::TestWithParam<const char*> {
 protected:
  static std::string read(const std::string& name) {
    return read_plain_name(ConfigReader::from_text("name: \"" + name + "\"", "test.yaml"), "name");
  }
};

using GoodName = PlainName;
TEST_P(GoodName, IsTaken) {
  EXPECT_EQ(read(GetParam()), GetParam());
}
INSTANTIATE_TEST_SUITE_P(Names, GoodName,
                         ::testing::Values("a", "rising-boxes", "drop_40cm", "v1.2", "-x"));

using BadName = PlainName;
TEST_P(BadName, IsRefusedWithLineAndKey) {
  try {
    (void)read(GetParam());
    ADD_FAILURE() << "taken";
  } catch (const ConfigError& error) {
    EXPECT_EQ(std::string(error.what()).find("test.yaml:1: name = "), 0U) << error.what();
  }
}
INSTANTIATE_TEST_SUITE_P(Names, BadName,
                         ::testing::Values("", ".", "..", ".hidden", "../../evil", "/evil", "a/b",
                                           "a\\\\b", "my steps", "ä", "a\\nb"));

TEST(PlainNames, HaveALength) {
  const std::string longest(100, 'n');
  const auto read = [](const std::string& name) {
    return read_plain_name(ConfigReader::from_text("name: " + name, "test.yaml"), "name");
  };
  EXPECT_EQ(read(longest), longest);
  EXPECT_THROW((void)read(longest + "n"), ConfigError);
}

}  // namespace
}  // namespace hopscotch::core
