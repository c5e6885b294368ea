// The automaton of path expressions against std::regex, for paths read from both ends.

#include "renderer/path/path_letters.h"

#include <gtest/gtest.h>

#include <regex>
#include <string>

namespace lacuna {
namespace {

using State = PathAutomaton::State;
using Letters = std::vector<PathSymbol>;

/// All strings of up to `longest` letters.
std::vector<Letters> all_letters(std::size_t longest) {
  std::vector<Letters> all{{}};
  for (std::size_t i = 0; i < all.size(); ++i) {
    for (int s = 0; s < scattering_symbols && all[i].size() < longest; ++s) {
      Letters more = all[i];
      more.push_back(static_cast<PathSymbol>(s));
      all.push_back(std::move(more));
    }
  }
  return all;
}

/// The letters as characters a to f, between e and l.
std::string text_of(const Letters& letters) {
  std::string text = "e";
  for (const PathSymbol s : letters) text += "uvwxyz"[static_cast<std::size_t>(s)];
  return text + "l";
}

/// The expressions that match a path of which the first `from_eye` letters are read from the eye.
PathMatches read_from_both_ends(const PathAutomaton& automaton, const Letters& letters,
                                std::size_t from_eye) {
  State eye = 0, light = 0;
  for (std::size_t i = 0; i < from_eye; ++i) {
    eye = automaton.step(eye, letters[i], Transport::radiance);
  }
  for (std::size_t i = letters.size(); i > from_eye; --i) {
    light = automaton.step(light, letters[i - 1], Transport::importance);
  }
  return automaton.matches(eye, light);
}

/// An expression, and the same for std::regex over text_of(), from the eye to the light.
struct Written {
  const char *expression, *regex;
};
constexpr std::array<Written, 8> written{{
    {"EL", "el"},
    {"ED+L", "e[uv]+l"},
    {"LS+D.*E", "e[u-z]*[uv][yz]+l"},
    {"C(<TS>|G){2}[^S]?L", "e(z|[wx]){2}[u-x]?l"},
    {"E<R.>*<T.><R.>*L", "e[uwy]*[vxz][uwy]*l"},
    {"LD{1,2}(S|<.G>D)*E", "e([yz]|[uv][wx])*[uv]{1,2}l"},
    {"E[DG]*S[DG]*L", "e[u-x]*[yz][u-x]*l"},
    {"E...L", "e[u-z]{3}l"},
}};

TEST(PathAutomata, MatchWhatStdRegexMatchesFromWhereverTheyAreRead) {
  const std::vector<Letters> all = all_letters(4);
  for (const bool others : {false, true}) {
    std::vector<PathExpression> expressions;
    std::vector<std::regex> regexes;
    for (const Written& w : written) {
      expressions.push_back(path_expression((others ? "!" : "") + std::string(w.expression)));
      regexes.emplace_back(w.regex);
    }
    const PathAutomaton automaton(expressions);
    std::array<int, written.size()> matching{};
    for (const Letters& letters : all) {
      unsigned expected = 0;
      for (std::size_t k = 0; k < written.size(); ++k) {
        const bool is = std::regex_match(text_of(letters), regexes[k]);
        matching[k] += is ? 1 : 0;
        if (is != others) expected |= 1U << k;
      }
      for (std::size_t at = 0; at <= letters.size(); ++at) {
        ASSERT_EQ(read_from_both_ends(automaton, letters, at), expected)
            << text_of(letters) << ", the first " << at << " from the eye";
      }
    }
    for (const int n : matching) EXPECT_GT(n, 0);
  }
}

TEST(PathExpressions, BeginAndEndAtTheEyeAndTheLight) {
  for (const char* good : {"EL", "E.*L", "CDL", "LDDE", "!LDE", "(EDL|ESL)", "E(D|S*)L"}) {
    EXPECT_NO_THROW(path_expression(good)) << good;
  }
  for (const char* bad : {"", "!", "D", "ED", "DL", "E.*", "E?L", "EDLDL", "EEL", "EL|LE", "E(L)?",
                          ".*", "LDL", "EDE"}) {
    EXPECT_THROW(path_expression(bad), std::invalid_argument) << bad;
  }
}

TEST(PathAutomata, RefuseMoreStatesThanAByteHolds) {
  const auto automaton = [](const char* text) {
    return PathAutomaton(std::array{path_expression(text)});
  };
  EXPECT_NO_THROW(automaton("E.*D.{6}L"));
  EXPECT_THROW(automaton("E.*D.{12}L"), std::length_error);
}

}  // namespace
}  // namespace lacuna
