#include "base/json/json_cursor.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <vector>

#include "base/json/json_text.h"

namespace lacuna {
namespace {

class Noted final : public JsonProblems {
 public:
  void add(const std::string& pointer, const std::string& message) override {
    lines.push_back(pointer + ": " + message);
  }
  std::vector<std::string> lines;
};

struct Document {
  Json json;
  Noted noted = {};
  JsonCursor root{json, "", noted};

  explicit Document(std::string_view text) : json(parse_own_sorted(text)) {}
  JsonCursor at(std::string_view key) const { return root.at(key); }
  /// The one problem since the last call.
  std::string problem() {
    EXPECT_EQ(noted.lines.size(), 1U);
    std::string line = noted.lines.empty() ? "" : noted.lines.back();
    noted.lines.clear();
    return line;
  }
};

TEST(Limits, AreToldInWords) {
  EXPECT_EQ(range_text({}), "");
  EXPECT_EQ(range_text({.min = 1, .max = 4294967295.0, .unit = "px"}), "from 1 to 4294967295 px");
  EXPECT_EQ(range_text({.min = 0, .max = 1e7, .above_min = true}), "above 0, at most 10000000");
  EXPECT_EQ(range_text({.min = 0.05}), "at least 0.05");
  EXPECT_EQ(range_text({.max = -2}), "at most -2");
}

TEST(JsonCursor, ReadsWhatIsAllowed) {
  Document d(R"({"flag": true, "real": -0.5, "whole": 1e3, "digits": 4294967295, "text": "a",
                 "list": [1, [2]]})");
  EXPECT_EQ(d.at("flag").boolean(), true);
  EXPECT_EQ(d.at("real").number({-0.5, -0.5}), -0.5);
  EXPECT_EQ(d.at("whole").integer({1000, 1000}), 1000);
  EXPECT_EQ(d.at("digits").digits({0, 4294967295.0}), 4294967295U);
  EXPECT_EQ(d.at("text").string(), "a");
  EXPECT_TRUE(d.root.check_object());
  EXPECT_TRUE(d.at("list").check_list({2, 2}));
  EXPECT_TRUE(d.at("list").check_list_of(2));
  EXPECT_EQ(d.at("list").at(std::size_t{1}).at(std::size_t{0}).pointer(), "/list/1/0");
  EXPECT_FALSE(d.root.find("absent"));
  EXPECT_EQ(d.noted.lines, std::vector<std::string>{});
}

TEST(JsonCursor, ARefusalNamesPlaceValueAndWhatIsAllowed) {
  Document d(R"({"a/b": {"~": [true, 1.5, -1, 512.0, "\u00e4"]}, "null": null})");
  const JsonCursor list = d.at("a/b").at("~");
  const auto element = [&](std::size_t i) { return list.at(i); };
  EXPECT_FALSE(element(0).number({}));
  EXPECT_EQ(d.problem(), "/a~1b/~0/0: found true; allowed: a number");
  EXPECT_FALSE(element(1).number({.min = 1.5, .max = 2, .above_min = true}));
  EXPECT_EQ(d.problem(), "/a~1b/~0/1: found number 1.5; allowed: a number above 1.5, at most 2");
  EXPECT_FALSE(element(1).integer({1, 2}));
  EXPECT_EQ(d.problem(), "/a~1b/~0/1: found number 1.5; allowed: an integer from 1 to 2");
  EXPECT_FALSE(element(2).digits({0, 9}));
  EXPECT_EQ(d.problem(), "/a~1b/~0/2: found number -1; allowed: an integer from 0 to 9");
  EXPECT_EQ(element(3).integer({}), 512);
  EXPECT_FALSE(element(3).digits({0, 1000}));
  EXPECT_EQ(d.problem(), "/a~1b/~0/3: found number 512.0; allowed: an integer from 0 to 1000");
  EXPECT_FALSE(element(4).boolean());
  EXPECT_EQ(d.problem(), "/a~1b/~0/4: found string \"\\u00e4\"; allowed: true or false");
  EXPECT_FALSE(list.string());
  EXPECT_EQ(d.problem(), "/a~1b/~0: found a list of 5; allowed: a string");
  EXPECT_FALSE(list.check_list({.max = 4}));
  EXPECT_EQ(d.problem(), "/a~1b/~0: found a list of 5; allowed: a list of at most 4 elements");
  EXPECT_FALSE(list.check_list_of(4));
  EXPECT_EQ(d.problem(), "/a~1b/~0: found a list of 5; allowed: a list of exactly 4");
  EXPECT_FALSE(d.at("null").check_object());
  EXPECT_EQ(d.problem(), "/null: found null; allowed: an object");
  d.root.refuse_missing("scene", "a file");
  EXPECT_EQ(d.problem(), "/scene: missing; required: a file");
}

TEST(JsonCursor, LongTextsAreCut) {
  Document d("{}");
  const Json text = std::string(100, 'x');
  d.root.in_place(text).refuse("less");
  EXPECT_EQ(d.problem(), ": found string \"" + std::string(60, 'x') + "\"...; allowed: less");
}

}  // namespace
}  // namespace lacuna
