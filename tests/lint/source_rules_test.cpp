#include "tests/lint/source_rules.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace hopscotch::lint {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

/// What is wrong with one file, as "line: rule" joined by '|'.
std::string wrong_with(const std::string& path, const std::string& text) {
  std::string result;
  for (const Violation& violation : check_sources({{path, text}})) {
    if (!result.empty()) result += "|";
    result += std::to_string(violation.line) + ": " + violation.rule;
  }
  return result;
}

struct IncludeCase {
  const char* path;
  const char* include;
  const char* rule;  ///< Empty if it is allowed.
};

class IncludeRules : public ::testing::TestWithParam<IncludeCase> {};

TEST_P(IncludeRules, Hold) {
  const std::string found =
      wrong_with(GetParam().path, std::string("#include ") + GetParam().include + "\n");
  EXPECT_EQ(found, *GetParam().rule == '\0' ? "" : std::string("1: ") + GetParam().rule);
}

INSTANTIATE_TEST_SUITE_P(
    Folders, IncludeRules,
    ::testing::Values(
        IncludeCase{"core/a.hpp", "\"core/time.hpp\"", ""},
        IncludeCase{"core/a.hpp", "\"model/motor.hpp\"", "core must not include model"},
        IncludeCase{"model/a.hpp", "\"core/time.hpp\"", ""},
        IncludeCase{"model/a.hpp", "\"planner/b.hpp\"", "model must not include planner"},
        IncludeCase{"planner/a.cpp", "\"model/motor.hpp\"", ""},
        IncludeCase{"planner/a.cpp", "\"control/b.hpp\"", "planner must not include control"},
        IncludeCase{"sim/a.cpp", "\"perception/b.hpp\"", "sim must not include perception"},
        IncludeCase{"msgs/a.cpp", "\"model/motor.hpp\"", "msgs must not include model"},
        IncludeCase{"control/a.cpp", "\"apps/b.hpp\"", "control must not include apps"},
        IncludeCase{"control/a.cpp", "\"tests/b.hpp\"", "only tests include tests"},
        IncludeCase{"apps/a.cpp", "\"sim/b.hpp\"", ""},
        IncludeCase{"tests/unit/sim/a_test.cpp", "\"planner/b.hpp\"", ""}));

INSTANTIATE_TEST_SUITE_P(
    Libraries, IncludeRules,
    ::testing::Values(
        IncludeCase{"perception/a.cpp", "<opencv2/core.hpp>", ""},
        IncludeCase{"control/a.cpp", "<opencv2/core.hpp>", "OpenCV does not live here"},
        IncludeCase{"planner/ipopt_problem.cpp", "<IpTNLP.hpp>", ""},
        IncludeCase{"planner/jump_planner.cpp", "<coin/IpTNLP.hpp>", "Ipopt does not live here"},
        IncludeCase{"sim/a.cpp", "<mujoco/mujoco.h>", ""},
        IncludeCase{"apps/a.cpp", "<mujoco/mujoco.h>", "MuJoCo does not live here"},
        IncludeCase{"core/config_reader.cpp", "<yaml-cpp/yaml.h>", ""},
        IncludeCase{"core/other.cpp", "<yaml-cpp/yaml.h>", "yaml-cpp does not live here"},
        IncludeCase{"model/a.cpp", "<gtest/gtest.h>", "GoogleTest does not live here"},
        IncludeCase{"planner/a.hpp", "<Eigen/Core>", ""}));

TEST(SourceRules, LibraryMustNotShowInAHeaderOfAnotherFoldersUse) {
  const std::vector<Violation> violations =
      check_sources({{"sim/inner.hpp", "#include <mujoco/mujoco.h>\n"},
                     {"sim/front.hpp", "#include \"sim/inner.hpp\"\n"},
                     {"sim/front.cpp", "#include \"sim/front.hpp\"\n"},
                     {"apps/run.cpp", "#include \"sim/front.hpp\"\n"}});
  ASSERT_THAT(violations, SizeIs(1));
  EXPECT_EQ(violations[0].path, "apps/run.cpp");
  EXPECT_THAT(violations[0].rule, HasSubstr("sim/front.hpp shows an external library"));
}

TEST(SourceRules, LongFileIsNamed) {
  std::string text;
  for (int line = 0; line < 500; ++line) text += "int a;\n";
  EXPECT_EQ(wrong_with("core/a.cpp", text), "");
  EXPECT_EQ(wrong_with("core/a.cpp", text + "int b;\n"), "501: file of 501 lines, limit 500");
}

TEST(SourceRules, LongFunctionIsNamed) {
  std::string body;
  for (int line = 0; line < 58; ++line) body += "  g();\n";
  EXPECT_EQ(wrong_with("core/a.cpp", "void f() {\n" + body + "}\n"), "");
  EXPECT_EQ(wrong_with("core/a.cpp", "void f() {\n" + body + "  g();\n}\n"),
            "1: function of 61 lines, limit 60");
}

TEST(SourceRules, LongParameterListIsNamed) {
  EXPECT_EQ(wrong_with("core/a.cpp", "void f(int a, int b, int c, int d, int e) {}\n"), "");
  EXPECT_EQ(wrong_with("core/a.cpp", "void f(int a, int b, int c, int d, int e, int g) {}\n"),
            "1: 6 parameters, limit 5");
}

TEST(SourceRules, BooleanParameterIsNamed) {
  EXPECT_THAT(wrong_with("core/a.cpp", "void f(int a, bool fast) {}\n"),
              HasSubstr("boolean parameter 'bool fast'"));
}

TEST(SourceRules, LibraryCodeReadsNoClockAndPrintsNothing) {
  EXPECT_THAT(wrong_with("planner/a.cpp", "int x;\nauto t = steady_clock::now();\n"),
              HasSubstr("2: steady_clock is not for library code"));
  EXPECT_THAT(wrong_with("planner/a.cpp", "void f() { std::cout << 1; }\n"),
              HasSubstr("cout is not for library code"));
  EXPECT_EQ(wrong_with("apps/a.cpp", "void f() { std::cout << 1; }\n"), "");
  EXPECT_EQ(wrong_with("planner/a.cpp", "// printf is not for us\n"), "");
}

TEST(SourceRules, CleanTreeHasNoBreach) {
  EXPECT_THAT(check_sources({{"core/a.hpp", "#pragma once\n"},
                             {"core/a.cpp", "#include \"core/a.hpp\"\nint f() { return 1; }\n"}}),
              IsEmpty());
}

}  // namespace
}  // namespace hopscotch::lint
