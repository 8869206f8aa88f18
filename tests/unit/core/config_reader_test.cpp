#include "core/config_reader.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <functional>
#include <string>

namespace hopscotch::core {
namespace {

using ::testing::ElementsAre;

ConfigReader read(std::string_view text) {
  return ConfigReader::from_text(text, "test.yaml");
}

/// For calls that are made for their complaint only.
template <typename T>
void discard(const T& /*value*/) {}

/// The message of the ConfigError that `action` throws; empty if it throws none.
std::string complaint(const std::function<void()>& action) {
  try {
    action();
  } catch (const ConfigError& error) {
    return error.what();
  }
  return {};
}

std::string complaint_about(std::string_view text,
                            const std::function<void(const ConfigReader&)>& use) {
  return complaint([&] { use(read(text)); });
}

TEST(ConfigReader, ReadsEachTypeOfValue) {
  const ConfigReader reader = read(
      "mass_kg: 13.65\n"
      "horizon: 10\n"
      "enabled: true\n"
      "name: hector\n"
      "mode: fast\n"
      "weights: [1, 2.5, -3e2]\n"
      "inner: {x_m: 0.5}\n"
      "slabs:\n"
      "  - {top_m: 0.0}\n"
      "  - {top_m: 0.1}\n");
  EXPECT_EQ(reader.number("mass_kg"), 13.65);
  EXPECT_EQ(reader.integer("horizon", 1, 20), 10);
  EXPECT_TRUE(reader.flag("enabled"));
  EXPECT_EQ(reader.text("name"), "hector");
  EXPECT_EQ(reader.choice("mode", {"slow", "fast"}), 1);
  EXPECT_EQ(reader.vector<3>("weights"), Eigen::Vector3d(1.0, 2.5, -300.0));
  EXPECT_THAT(reader.number_list("weights"), ElementsAre(1.0, 2.5, -300.0));
  EXPECT_EQ(reader.section("inner").number("x_m"), 0.5);
  ASSERT_EQ(reader.list("slabs").size(), 2U);
  EXPECT_EQ(reader.list("slabs")[1].number("top_m"), 0.1);
  EXPECT_NO_THROW(reader.finish());
}

TEST(ConfigReader, KeysStandInTheOrderOfTheFile) {
  EXPECT_THAT(read("b: 1\na: 2\nc: 3\n").keys(), ElementsAre("b", "a", "c"));
}

TEST(ConfigReader, UnknownKeyIsNamedWithItsLine) {
  EXPECT_EQ(complaint_about("mu: 0.5\nmuu: 0.6\n",
                            [](const ConfigReader& reader) {
                              discard(reader.number("mu"));
                              reader.finish();
                            }),
            "test.yaml:2: muu is not a known key here");
}

TEST(ConfigReader, UnknownKeyOfASectionIsNamedWithItsPath) {
  EXPECT_EQ(complaint_about("control:\n  wrench_mpc:\n    mu: 0.5\n    nu: 1\n",
                            [](const ConfigReader& reader) {
                              const ConfigReader inner =
                                  reader.section("control").section("wrench_mpc");
                              discard(inner.number("mu"));
                              inner.finish();
                            }),
            "test.yaml:4: control.wrench_mpc.nu is not a known key here");
}

TEST(ConfigReader, UnknownKeyOfAListEntryIsNamedWithItsIndex) {
  EXPECT_EQ(complaint_about("slabs:\n  - {top_m: 0}\n  - {top: 0}\n",
                            [](const ConfigReader& reader) {
                              for (const ConfigReader& slab : reader.list("slabs")) {
                                discard(slab.number_or("top_m", 0.0));
                                slab.finish();
                              }
                            }),
            "test.yaml:3: slabs[1].top is not a known key here");
}

TEST(ConfigReader, FinishAcceptsAMappingWhoseCopyWasRead) {
  const ConfigReader reader = read("mu: 0.5\n");
  const ConfigReader copy = reader;  // NOLINT(performance-unnecessary-copy-initialization)
  EXPECT_EQ(copy.number("mu"), 0.5);
  EXPECT_NO_THROW(reader.finish());
}

TEST(ConfigReader, HasDoesNotCountAsReading) {
  const ConfigReader reader = read("mu: 0.5\n");
  EXPECT_TRUE(reader.has("mu"));
  EXPECT_FALSE(reader.has("nu"));
  EXPECT_THROW(reader.finish(), ConfigError);
}

TEST(ConfigReader, DefaultsHoldOnlyForAbsentKeys) {
  const ConfigReader reader = read("a: 2\nb: word\n");
  EXPECT_EQ(reader.number_or("a", 7.0), 2.0);
  EXPECT_EQ(reader.number_or("z", 7.0), 7.0);
  EXPECT_EQ(reader.integer_or("a", 7, 0, 9), 2);
  EXPECT_EQ(reader.integer_or("z", 7, 0, 9), 7);
  EXPECT_EQ(reader.text_or("b", "other"), "word");
  EXPECT_EQ(reader.text_or("z", "other"), "other");
  EXPECT_FALSE(reader.section_if("z").has_value());
  EXPECT_TRUE(reader.list_if("z").empty());
}

TEST(ConfigReader, DefaultDoesNotHideABrokenValue) {
  const ConfigReader reader = read("a: -2\n");
  EXPECT_THROW(discard(reader.number_or("a", 7.0, Range::positive())), ConfigError);
  EXPECT_THROW(discard(reader.integer_or("a", 7, 0, 9)), ConfigError);
  EXPECT_THROW(discard(reader.section_if("a")), ConfigError);
  EXPECT_THROW(discard(reader.list_if("a")), ConfigError);
}

struct Refused {
  const char* name;
  const char* yaml;
  std::function<void(const ConfigReader&)> use;
  const char* message;
};

class ConfigReaderRefuses : public ::testing::TestWithParam<Refused> {};

TEST_P(ConfigReaderRefuses, WithPlaceValueAndRule) {
  EXPECT_EQ(complaint_about(GetParam().yaml, GetParam().use), GetParam().message);
}

using R = const ConfigReader&;
INSTANTIATE_TEST_SUITE_P(
    Values, ConfigReaderRefuses,
    ::testing::Values(
        Refused{"MissingNumber", "a: 1\n", [](R r) { discard(r.number("b")); },
                "test.yaml:1: b is missing"},
        Refused{"MissingInteger", "a: 1\n", [](R r) { discard(r.integer("b", 0, 1)); },
                "test.yaml:1: b is missing"},
        Refused{"MissingFlag", "a: 1\n", [](R r) { discard(r.flag("b")); },
                "test.yaml:1: b is missing"},
        Refused{"MissingText", "a: 1\n", [](R r) { discard(r.text("b")); },
                "test.yaml:1: b is missing"},
        Refused{"MissingNumbers", "a: 1\n", [](R r) { discard(r.numbers("b", 2)); },
                "test.yaml:1: b is missing"},
        Refused{"MissingSection", "a: 1\n", [](R r) { discard(r.section("b")); },
                "test.yaml:1: b is missing"},
        Refused{"MissingList", "a: 1\n", [](R r) { discard(r.list("b")); },
                "test.yaml:1: b is missing"},
        Refused{"WordAsNumber", "x: 1\na: fast\n", [](R r) { discard(r.number("a")); },
                "test.yaml:2: a = fast, but must be a number"},
        Refused{"NumberWithUnit", "a: 3 m\n", [](R r) { discard(r.number("a")); },
                "test.yaml:1: a = 3 m, but must be a number"},
        Refused{"EmptyAsNumber", "a:\n", [](R r) { discard(r.number("a")); },
                "test.yaml:1: a = ~, but must be a number"},
        Refused{"ListAsNumber", "a: [1, 2]\n", [](R r) { discard(r.number("a")); },
                "test.yaml:1: a = [1, 2], but must be a number"},
        Refused{"NotANumber", "a: .nan\n", [](R r) { discard(r.number("a")); },
                "test.yaml:1: a = .nan, but must be finite"},
        Refused{"Infinite", "a: -.inf\n", [](R r) { discard(r.number("a")); },
                "test.yaml:1: a = -.inf, but must be finite"},
        Refused{"TooLarge", "a: 1.7\n", [](R r) { discard(r.number("a", Range::above(0.0, 1.2))); },
                "test.yaml:1: a = 1.7, but must satisfy 0 < x <= 1.2"},
        Refused{"AtOpenEnd", "a: 0\n", [](R r) { discard(r.number("a", Range::above(0.0, 1.2))); },
                "test.yaml:1: a = 0, but must satisfy 0 < x <= 1.2"},
        Refused{"NotPositive", "a: 0\n", [](R r) { discard(r.number("a", Range::positive())); },
                "test.yaml:1: a = 0, but must satisfy 0 < x"},
        Refused{"Negative", "a: -1\n", [](R r) { discard(r.number("a", Range::not_negative())); },
                "test.yaml:1: a = -1, but must satisfy 0 <= x"},
        Refused{"FractionAsInteger", "a: 2.5\n", [](R r) { discard(r.integer("a", 0, 9)); },
                "test.yaml:1: a = 2.5, but must be a whole number"},
        Refused{"IntegerTooBigForInt", "a: 3000000000\n",
                [](R r) { discard(r.integer("a", 0, 9)); },
                "test.yaml:1: a = 3000000000, but must be a whole number"},
        Refused{"IntegerOutOfRange", "a: 21\n", [](R r) { discard(r.integer("a", 1, 20)); },
                "test.yaml:1: a = 21, but must satisfy 1 <= x <= 20"},
        Refused{"NumberAsFlag", "a: 1\n", [](R r) { discard(r.flag("a")); },
                "test.yaml:1: a = 1, but must be true or false"},
        Refused{"EmptyText", "a: ''\n", [](R r) { discard(r.text("a")); },
                "test.yaml:1: a = , but must be a text"},
        Refused{"MappingAsText", "a: {b: 1}\n", [](R r) { discard(r.text("a")); },
                "test.yaml:1: a = {b: 1}, but must be a text"},
        Refused{"UnknownChoice", "a: medium\n",
                [](R r) {
                  discard(r.choice("a", {"slow", "fast"}));
                },
                "test.yaml:1: a = medium, but must be one of slow, fast"},
        Refused{"NumberAsList", "a: 1\n", [](R r) { discard(r.number_list("a")); },
                "test.yaml:1: a = 1, but must be a list of numbers"},
        Refused{"EmptyList", "a: []\n", [](R r) { discard(r.number_list("a")); },
                "test.yaml:1: a = [], but must be a list of numbers"},
        Refused{"WordInList", "a: [1, x]\n", [](R r) { discard(r.number_list("a")); },
                "test.yaml:1: a = [1, x], but must be a list of finite numbers"},
        Refused{"RangeInList", "a: [1, -1]\n",
                [](R r) { discard(r.number_list("a", Range::not_negative())); },
                "test.yaml:1: a = [1, -1], but must satisfy 0 <= x in each entry"},
        Refused{"WrongListSize", "a: [1, 2]\n", [](R r) { discard(r.vector<3>("a")); },
                "test.yaml:1: a = [1, 2], but must be a list of 3 numbers"},
        Refused{"NumberAsSection", "a: 1\n", [](R r) { discard(r.section("a")); },
                "test.yaml:1: a = 1, but must be a mapping"},
        Refused{"MappingAsListOfMappings", "a: {b: 1}\n", [](R r) { discard(r.list("a")); },
                "test.yaml:1: a = {b: 1}, but must be a list of mappings"},
        Refused{"NumbersAsListOfMappings", "a: [1, 2]\n", [](R r) { discard(r.list("a")); },
                "test.yaml:1: a = [1, 2], but must be a list of mappings"},
        Refused{"OwnRule", "a: 3\n", [](R r) { r.reject("a", "must not overlap slab 2"); },
                "test.yaml:1: a = 3, but must not overlap slab 2"}),
    [](const ::testing::TestParamInfo<Refused>& test) { return std::string(test.param.name); });

class ConfigReaderRefusesText : public ::testing::TestWithParam<Refused> {};

TEST_P(ConfigReaderRefusesText, AsAWhole) {
  EXPECT_EQ(complaint_about(GetParam().yaml, GetParam().use), GetParam().message);
}

const auto kUseNothing = [](R /*reader*/) {};
INSTANTIATE_TEST_SUITE_P(
    Texts, ConfigReaderRefusesText,
    ::testing::Values(
        Refused{"Empty", "", kUseNothing, "test.yaml:1: must be a mapping of keys to values"},
        Refused{"Scalar", "just words\n", kUseNothing,
                "test.yaml:1: must be a mapping of keys to values"},
        Refused{"Sequence", "- 1\n", kUseNothing,
                "test.yaml:1: must be a mapping of keys to values"},
        Refused{"DuplicateKey", "a: 1\nb: 2\na: 3\n", kUseNothing,
                "test.yaml:3: key 'a' stands here twice"},
        Refused{"DuplicateKeyInside", "s:\n  - {a: 1, a: 2}\n", kUseNothing,
                "test.yaml:2: key 'a' stands here twice"},
        Refused{"ListAsKey", "[1, 2]: 3\n", kUseNothing, "test.yaml:1: keys must be plain words"},
        Refused{"SecondDocument", "a: 1\n---\nb: 2\n", kUseNothing,
                "test.yaml: holds a second document ('---'), but only one is read"},
        Refused{"AliasInItsOwnAnchor", "a: &a {b: *a}\n", kUseNothing,
                "test.yaml:1: not valid YAML: anchors and aliases are not allowed here"},
        Refused{"AnchoredScalar", "x: 0\na: &a 1\n", kUseNothing,
                "test.yaml:2: not valid YAML: anchors and aliases are not allowed here"}),
    [](const ::testing::TestParamInfo<Refused>& test) { return std::string(test.param.name); });

TEST(ConfigReader, SyntaxErrorNamesTheLine) {
  EXPECT_THAT(complaint([] { read("a: 1\nb: [1, 2\nc: 3\n"); }),
              ::testing::MatchesRegex("test\\.yaml:[0-9]+: not valid YAML: .+"));
}

TEST(ConfigReader, BrokenValueOnManyLinesIsPlacedAtItsKey) {
  EXPECT_EQ(complaint_about("x: 0\na:\n  - 1\n  - -1\n",
                            [](R r) { discard(r.number_list("a", Range::positive())); }),
            "test.yaml:2: a = [1, -1], but must satisfy 0 < x in each entry");
}

TEST(ConfigReader, BoundsOfAClosedRangeAreInside) {
  const ConfigReader reader = read("low: 0\nhigh: 1\n");
  EXPECT_EQ(reader.number("low", Range::closed(0.0, 1.0)), 0.0);
  EXPECT_EQ(reader.number("high", Range::closed(0.0, 1.0)), 1.0);
}

TEST(ConfigReader, PlaceIsFileAndLineOfTheMapping) {
  EXPECT_EQ(read("a: 1\nb:\n  c: 1\n").section("b").place(), "test.yaml:3");
}

class ConfigFile : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::path(::testing::TempDir()) /
              ::testing::UnitTest::GetInstance()->current_test_info()->name();
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::filesystem::path folder_;
};

TEST_F(ConfigFile, IsReadLikeText) {
  const std::filesystem::path file = folder_ / "good.yaml";
  std::ofstream(file) << "a: 1\n";
  EXPECT_EQ(ConfigReader::from_file(file).number("a"), 1.0);
}

TEST_F(ConfigFile, ThatIsMissingIsNamed) {
  const std::filesystem::path file = folder_ / "absent.yaml";
  EXPECT_EQ(complaint([&] { ConfigReader::from_file(file); }), file.string() + ": no such file");
}

TEST_F(ConfigFile, ThatIsAFolderIsRefused) {
  EXPECT_EQ(complaint([&] { ConfigReader::from_file(folder_); }),
            folder_.string() + ": is no regular file");
}

TEST_F(ConfigFile, LongerThanOneBlockIsReadToItsEnd) {
  const std::filesystem::path file = folder_ / "long.yaml";
  {
    std::ofstream out(file);
    out << "a: 1\n";
    for (int line = 0; line < 10000; ++line) out << "# padding line\n";
    out << "b: 2\n";
  }
  EXPECT_EQ(ConfigReader::from_file(file).number("b"), 2.0);
}

}  // namespace
}  // namespace hopscotch::core
