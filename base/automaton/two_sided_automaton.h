#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/automaton/regular_expression.h"

namespace lacuna {

/// An expression, or all words but those that it matches.
struct MatchedWords {
  RegularExpression expression;
  bool others = false;
};

/// Some expressions as one deterministic automaton that reads a word from both ends: the beginning
/// forward, the rest backward. The two states that it is then in give the expressions that match
/// the whole word, wherever the two parts meet.
class TwoSidedAutomaton {
 public:
  using State = std::uint8_t;    ///< of one direction; 0 at its end of the word
  using Matches = std::uint8_t;  ///< a bit for each expression

  /// Of at most 8 expressions over words that begin with the symbol `first`, end with `last`, and
  /// have symbols below `symbols` between; State 0 is after `first`, or before `last`. Throws
  /// std::length_error if more than 256 states of one direction are needed.
  TwoSidedAutomaton(std::span<const MatchedWords> expressions, int symbols, int first, int last);

  State forward(State s, int symbol) const { return next(forward_, s, symbol); }
  State backward(State s, int symbol) const { return next(backward_, s, symbol); }
  Matches matches(State forward, State backward) const {
    return matches_[std::size_t{forward} * backward_states_ + backward];
  }

 private:
  State next(const std::vector<State>& table, State s, int symbol) const {
    return table[std::size_t{s} * symbols_ + static_cast<std::size_t>(symbol)];
  }

  std::size_t symbols_;
  std::vector<State> forward_, backward_;  // of each state and symbol
  std::size_t backward_states_ = 0;
  std::vector<Matches> matches_;  // of each pair of states
};

}  // namespace lacuna
