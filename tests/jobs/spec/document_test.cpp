#include <gtest/gtest.h>

#include "base/json/json_text.h"
#include "expect_problems.h"
#include "jobs/spec/json_document.h"

namespace lacuna {
namespace {

constexpr DocumentLimits limits{1000, 4};

/// All problems of a text, whether it can be gone on with or not.
std::vector<Problem> problems(std::string_view text) {
  std::vector<Problem> found;
  for (const Problem& p : problems_of([&] { parse_document(text, limits, found); })) {
    found.push_back(p);
  }
  return found;
}

TEST(Document, BuildsWhatTheTextSays) {
  std::vector<Problem> found;
  const std::string text = R"({"a":[1,-2,3.5,"x",null,true,[]],"b":{"c":{}}})";
  EXPECT_EQ(json_text(parse_document(text, limits, found)), text);
  EXPECT_TRUE(found.empty());
}

struct Malformed {
  const char* text;
  const char* place;  ///< and the excerpt with its caret
};

TEST(Document, MalformedJsonIsShownWhereItGoesWrong) {
  const Malformed cases[] = {
      {"", "line 1, column 1:\n\n^"},
      {"{\"a\": NaN}", "line 1, column 7:\n{\"a\": NaN}\n      ^"},
      {"[Infinity]", "line 1, column 2:\n[Infinity]\n ^"},
      {"[1,\n 2,\n  x]\n", "line 3, column 3:\n  x]\n  ^"},
      {"[1, 2", "line 1, column 6:\n[1, 2\n     ^"},
      {"[1] 2", "line 1, column 5:\n[1] 2\n    ^"},
      {"[1e999]", "line 1, column 6:\n[1e999]\n     ^"},
      {"[1, // no\n2]", "line 1, column 5:\n[1, // no\n    ^"},
      {"[\"\xc3\xa4\xc3\xb6\", x]", "line 1, column 8:\n[\"??\", x]\n       ^"},
      {"[01]", "line 1, column 3:\n[01]\n  ^"},
      {"{\"a\" 1}", "line 1, column 6:\n{\"a\" 1}\n     ^"},
  };
  for (const Malformed& c : cases) {
    SCOPED_TRACE(c.text);
    expect_one(problems(c.text), "", {"malformed JSON", c.place});
  }
}

TEST(Document, ALongLineIsCutAroundThePlace) {
  const std::string text = "[" + std::string(300, ' ') + "!" + std::string(300, ' ') + "]";
  const auto found = problems(text);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_NE(found[0].message.find("line 1, column 302:"), std::string::npos);
  EXPECT_NE(found[0].message.find("\n" + std::string(30, ' ') + "^"), std::string::npos);
  EXPECT_LT(found[0].message.size(), 300u);
}

TEST(Document, StringsMustBeValidUtf8) {
  for (const char* bytes : {"\xff", "\xc3", "\xc0\x80", "\xed\xa0\x80", "\xf5\x80\x80\x80"}) {
    expect_one(problems("[\"" + std::string(bytes) + "\"]"), "", {"malformed JSON", "UTF-8"});
  }
  expect_one(problems(R"(["\ud800"])"), "", {"malformed JSON"});
  expect_one(problems(std::string_view("[\"\0\"]", 5)), "", {"malformed JSON"});
}

TEST(Document, EachDuplicateKeyIsAProblem) {
  expect_one(problems(R"({"a": 1, "b": 2, "a": 1})"), "/a", {"duplicate key"});
  expect_one(problems(R"([0, {"x": {"/": [], "\u002f": 1}}])"), "/1/x/~1", {"duplicate key"});
  EXPECT_TRUE(problems(R"([{"a": 1}, {"a": {"a": 2}}])").empty());
}

TEST(Document, NestingIsLimitedBeforeAnythingDeepIsBuilt) {
  EXPECT_TRUE(problems("[[[[]]]]").empty());
  EXPECT_TRUE(problems(R"({"a":{"b":{"c":{"d":1}}}})").empty());
  expect_one(problems("[0,[[[[]]]]]"), "/1/0/0/0", {"too deep", "4 levels"});
  expect_one(problems(R"({"a":{"b":[{"d":[]}]}})"), "/a/b/0/d", {"too deep"});
  // Enough to overflow the stack of a recursive parser or destructor.
  std::vector<Problem> found;
  const std::string deep(1000000, '[');
  EXPECT_THROW(parse_document(deep, {deep.size(), 4}, found), BadJob);
}

TEST(Document, SizeIsLimited) {
  EXPECT_TRUE(problems("[" + std::string(998, ' ') + "]").empty());
  expect_one(problems("[" + std::string(999, ' ') + "]"), "", {"1001 bytes", "at most 1000"});
}

}  // namespace
}  // namespace lacuna
