#include "base/automaton/two_sided_automaton.h"

#include <fmt/format.h>

#include <map>
#include <stdexcept>

namespace lacuna {
namespace {

using State = TwoSidedAutomaton::State;
/// The states of each expression's automaton.
using StateSets = std::vector<RegularExpression::States>;

/// All sets that `step(set, symbol)` reaches from `start`, numbered in the order in which they are
/// found; appends the number of the next set for each set and symbol to `next`.
template <class Step>
std::vector<StateSets> reached(StateSets start, int symbols, std::vector<State>& next,
                               Step&& step) {
  constexpr std::size_t most = 256;
  std::vector<StateSets> sets{std::move(start)};
  std::map<StateSets, std::size_t> numbers{{sets[0], 0}};
  for (std::size_t i = 0; i < sets.size(); ++i) {
    for (int symbol = 0; symbol < symbols; ++symbol) {
      StateSets after = step(sets[i], symbol);
      const auto [at, is_new] = numbers.try_emplace(after, sets.size());
      if (is_new) sets.push_back(std::move(after));
      if (sets.size() > most) {
        throw std::length_error(
            fmt::format("the expressions together need more than {} states", most));
      }
      next.push_back(static_cast<State>(at->second));
    }
  }
  return sets;
}

}  // namespace

TwoSidedAutomaton::TwoSidedAutomaton(std::span<const MatchedWords> expressions, int symbols,
                                     int first, int last)
    : symbols_(static_cast<std::size_t>(symbols)) {
  const std::size_t n = expressions.size();
  StateSets begin, end;
  for (const MatchedWords& m : expressions) {
    begin.push_back(m.expression.step(1, first));
    end.push_back(m.expression.step_back(m.expression.accepting(), last));
  }
  const auto forward = [&](StateSets sets, int symbol) {
    for (std::size_t k = 0; k < n; ++k) sets[k] = expressions[k].expression.step(sets[k], symbol);
    return sets;
  };
  const auto backward = [&](StateSets sets, int symbol) {
    for (std::size_t k = 0; k < n; ++k)
      sets[k] = expressions[k].expression.step_back(sets[k], symbol);
    return sets;
  };
  const std::vector<StateSets> after = reached(begin, symbols, forward_, forward);
  const std::vector<StateSets> before = reached(end, symbols, backward_, backward);
  backward_states_ = before.size();
  for (const StateSets& a : after) {
    for (const StateSets& b : before) {
      unsigned matches = 0;
      for (std::size_t k = 0; k < n; ++k) {
        if (((a[k] & b[k]) != 0) != expressions[k].others) matches |= 1U << k;
      }
      matches_.push_back(static_cast<Matches>(matches));
    }
  }
}

}  // namespace lacuna
