// Expressions against std::regex, word by word.

#include "base/automaton/regular_expression.h"

#include <gtest/gtest.h>

#include <array>
#include <random>
#include <regex>
#include <string>

namespace lacuna {
namespace {

constexpr std::array<SymbolName, 4> names{{{"a", 1}, {"b", 2}, {"c", 4}, {"ab", 3}}};
constexpr std::array<SymbolName, 3> letters{{{"a", 1}, {"b", 2}, {"c", 4}}};

RegularExpression::States after(const RegularExpression& e, std::string_view word) {
  RegularExpression::States states = 1;
  for (const char c : word) states = e.step(states, c - 'a');
  return states;
}
RegularExpression::States before(const RegularExpression& e, std::string_view word) {
  RegularExpression::States states = e.accepting();
  for (auto c = word.rbegin(); c != word.rend(); ++c) states = e.step_back(states, *c - 'a');
  return states;
}
bool matches(const RegularExpression& e, std::string_view word) {
  return (after(e, word) & e.accepting()) != 0;
}

std::vector<std::string> words(std::size_t longest) {
  std::vector<std::string> all{""};
  for (std::size_t i = 0; i < all.size(); ++i) {
    for (const char c : {'a', 'b', 'c'}) {
      if (all[i].size() < longest) all.push_back(all[i] + c);
    }
  }
  return all;
}

/// A random expression that std::regex reads in the same way.
class RandomExpression {
 public:
  explicit RandomExpression(unsigned seed) : random_(seed) {}
  std::string next(int depth = 3) {
    std::string all;
    const unsigned parts = 1 + below(3);
    for (unsigned k = 0; k < parts; ++k) all += (k > 0 && below(3) == 0 ? "|" : "") + part(depth);
    return all;
  }

 private:
  unsigned below(unsigned n) { return static_cast<unsigned>(random_() % n); }
  std::string part(int depth) {
    static constexpr std::array<const char*, 8> atoms{"a",    "b",    "c",     ".",
                                                      "[ab]", "[^a]", "[^bc]", "[bc]"};
    static constexpr std::array<const char*, 10> repeats{"",  "",    "",      "*",     "+",
                                                         "?", "{2}", "{1,2}", "{0,2}", "{2,}"};
    std::string text = depth > 0 && below(3) == 0 ? "(" : atoms[below(atoms.size())];
    if (text == "(") text = "(" + next(depth - 1) + ")";
    return text + repeats[below(repeats.size())];
  }
  std::mt19937 random_;
};

TEST(RegularExpressions, MatchTheWordsOfStdRegex) {
  const std::vector<std::string> all = words(5);
  RandomExpression random(1);
  int matching = 0, compared = 0;
  for (int k = 0; k < 60; ++k) {
    const std::string text = random.next();
    SCOPED_TRACE(text);
    std::optional<RegularExpression> found;
    try {
      found.emplace(text, letters, 7);
    } catch (const std::invalid_argument&) {
      continue;  // too long with its repetitions written out
    }
    const std::regex expected(text);
    for (const std::string& word : all) {
      const bool is = matches(*found, word);
      ASSERT_EQ(is, std::regex_match(word, expected)) << "\"" << word << "\"";
      const std::string back(word.rbegin(), word.rend());
      ASSERT_EQ(matches(found->reversed(), back), is) << "\"" << word << "\" read backward";
      for (std::size_t at = 0; at <= word.size(); ++at) {
        ASSERT_EQ((after(*found, word.substr(0, at)) & before(*found, word.substr(at))) != 0, is)
            << "\"" << word << "\" from both ends, to " << at;
      }
      matching += is ? 1 : 0;
      ++compared;
    }
  }
  EXPECT_GT(compared, 15000);
  EXPECT_GT(matching, 500);
}

TEST(RegularExpressions, ReadTheLongestNameOfTwo) {
  const RegularExpression e("abc", names, 7);
  EXPECT_TRUE(matches(e, "ac"));
  EXPECT_TRUE(matches(e, "bc"));
  EXPECT_FALSE(matches(e, "abc"));
}

TEST(RegularExpressions, SayWhereTheyAreWrong) {
  const auto error = [](std::string_view text) -> std::string {
    try {
      RegularExpression(text, letters, 7);
    } catch (const std::invalid_argument& e) {
      return e.what();
    }
    return "none";
  };
  EXPECT_TRUE(error("abx").starts_with("character 3: found \"x\"; allowed: a, b, c"));
  EXPECT_TRUE(error("a(b").starts_with("character 4: found the end; allowed: \")\""));
  EXPECT_TRUE(error("a)").starts_with("character 2: found \")\""));
  EXPECT_TRUE(error("*").starts_with("character 1: found \"*\""));
  EXPECT_TRUE(error("a{x}").starts_with("character 3: found \"x\"; allowed: a number"));
  EXPECT_TRUE(error("a{3,2}").find("not below the least") != std::string::npos);
  EXPECT_TRUE(error("a{99999999999}").find("allowed: a number") != std::string::npos);
  EXPECT_TRUE(error("[]").starts_with("character 2: found \"]\""));
  EXPECT_TRUE(error("[a").starts_with("character 3: found the end"));
  EXPECT_TRUE(error("a{64}").find("more than 63 symbols") != std::string::npos);
  EXPECT_TRUE(error("(a{60}){60}").find("more than 63 symbols") != std::string::npos);
  EXPECT_EQ(error("a{63}"), "none");
  EXPECT_EQ(error(""), "none");
}

}  // namespace
}  // namespace lacuna
