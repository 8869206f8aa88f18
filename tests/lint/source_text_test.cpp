#include "tests/lint/source_text.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace hopscotch::lint {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::SizeIs;

TEST(CodeOnly, BlanksCommentsAndLiteralsAndKeepsPlaces) {
  EXPECT_EQ(code_only("a /* b */ c // d\ne"), "a         c     \ne");
  EXPECT_EQ(code_only("x = \"a\\\"{b\"; y"), "x =        ; y");
  EXPECT_EQ(code_only("c = '{'; d"), "c =    ; d");
  EXPECT_EQ(code_only("R\"(one\n\")\" two"), "      \n    two");
}

TEST(CodeOnly, DigitSeparatorIsNoLiteral) {
  EXPECT_EQ(code_only("n = 1'000'000;"), "n = 1'000'000;");
}

TEST(Includes, AreFoundWithTheirLines) {
  const SourceFile file{"a.cpp", "#include <vector>\n\n#include \"core/time.hpp\"\n"};
  const std::vector<Include> includes = includes_of(file);
  ASSERT_THAT(includes, SizeIs(2));
  EXPECT_EQ(includes[0].name, "vector");
  EXPECT_EQ(includes[1].name, "core/time.hpp");
  EXPECT_EQ(includes[1].line, 3);
}

TEST(Includes, InCommentsAndStringsDoNotCount) {
  const SourceFile file{"a.cpp", "// #include <a>\nconst char* s = R\"(\n#include <b>\n)\";\n"};
  EXPECT_THAT(includes_of(file), IsEmpty());
}

TEST(Functions, FreeFunctionIsMeasuredBraceToBrace) {
  const std::vector<Function> found =
      functions_of("int f(int a,\n      int b) {\n  return 1;\n}\n");
  ASSERT_THAT(found, SizeIs(1));
  EXPECT_EQ(found[0].first_line, 2);
  EXPECT_EQ(found[0].last_line, 4);
  EXPECT_THAT(found[0].parameters, ElementsAre("int a", "int b"));
}

TEST(Functions, MembersConstructorsAndOperatorsAreFound) {
  EXPECT_THAT(functions_of("struct A {\n  int f() const { return 1; }\n};\n"), SizeIs(1));
  EXPECT_THAT(functions_of("A::A(int x) : x_(x), y_{x, 2} {\n}\n"), SizeIs(1));
  EXPECT_THAT(functions_of("bool operator()(int a, int b) const noexcept { return a < b; }"),
              SizeIs(1));
  EXPECT_THAT(functions_of("auto f(int a) -> double { return a; }"), SizeIs(1));
  EXPECT_THAT(functions_of("template <typename T> T f(T a) { return a; }"), SizeIs(1));
}

TEST(Functions, ControlFlowTypesAndInitialisersAreNone) {
  EXPECT_THAT(functions_of("namespace a { struct B { int c{3}; }; enum class D { e }; }"),
              IsEmpty());
  EXPECT_THAT(functions_of("const int x[] = {1, 2};\nconst auto y = f(3);\n"), IsEmpty());
  EXPECT_THAT(functions_of("void f() { if (a) { b(); } for (;;) { g([&](int i) { h(i); }); } }"),
              SizeIs(1));
}

TEST(Functions, CommasInsideTemplateArgumentsDoNotSplitParameters) {
  const std::vector<Function> found = functions_of("void f(std::map<int, int> a, int b) {}");
  ASSERT_THAT(found, SizeIs(1));
  EXPECT_THAT(found[0].parameters, ElementsAre("std::map<int, int> a", "int b"));
}

TEST(Functions, MacrosOfManyLinesAreSkippedAndCounted) {
  const std::vector<Function> found = functions_of("#define M(a) { \\\n  b; }\nvoid f() {\n}\n");
  ASSERT_THAT(found, SizeIs(1));
  EXPECT_EQ(found[0].first_line, 3);
}

TEST(HasWord, FindsWholeWordsOnly) {
  EXPECT_TRUE(has_word("std::cout << 1", "cout"));
  EXPECT_FALSE(has_word("snprintf(a)", "printf"));
  EXPECT_FALSE(has_word("operand", "rand"));
}

}  // namespace
}  // namespace hopscotch::lint
