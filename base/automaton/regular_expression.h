#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace lacuna {

/// A name that stands for some symbols of an alphabet.
struct SymbolName {
  std::string_view name;
  std::uint32_t symbols;  ///< a bit for each
};

/// A regular expression as an automaton without empty steps (Glushkov 1961, "The abstract theory of
/// automata"): each occurrence of a symbol in the expression is a state, entered by reading it, and
/// state 0 is the start.
class RegularExpression {
 public:
  /// A bit for each state.
  using States = std::uint64_t;
  static constexpr std::size_t most_states = 64;

  /// `names`: of the alphabet; of two that begin alike the longer one is read. `any`: the symbols
  /// of `.`. The expression may have groups `( )`, alternatives `|`, sets `[ ]` and `[^ ]` (`any`
  /// without these), and repetitions `*`, `+`, `?`, `{n}`, `{n,}`, `{n,m}`. Throws
  /// std::invalid_argument, whose text begins with the place of the error.
  RegularExpression(std::string_view text, std::span<const SymbolName> names, std::uint32_t any);

  std::size_t states() const { return symbols_.size(); }
  /// The symbols by which state `i` is entered; none for state 0.
  std::uint32_t symbols(std::size_t i) const { return symbols_[i]; }
  /// The states that may follow state `i`.
  States follow(std::size_t i) const { return follow_[i]; }
  /// The states in which a word may end.
  States accepting() const { return accepting_; }

  /// The states in which a word may be after `symbol`, from one of `before`.
  States step(States before, int symbol) const;
  /// The states from which `symbol` leads to one of `after`.
  States step_back(States after, int symbol) const;
  /// The expression of all words read backward.
  RegularExpression reversed() const;

 private:
  friend class ExpressionParser;
  RegularExpression() = default;

  std::vector<std::uint32_t> symbols_;
  std::vector<States> follow_;
  States accepting_ = 0;
};

}  // namespace lacuna
