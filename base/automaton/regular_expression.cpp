#include "base/automaton/regular_expression.h"

#include <fmt/format.h>

#include <bit>
#include <charconv>
#include <stdexcept>

namespace lacuna {
namespace {

using States = RegularExpression::States;

template <class Use>
void for_each_state(States states, Use&& use) {
  for (; states != 0; states &= states - 1) use(static_cast<std::size_t>(std::countr_zero(states)));
}

}  // namespace

/// Reads an expression, and appends the states of each part as it is read.
class ExpressionParser {
 public:
  ExpressionParser(std::string_view text, std::span<const SymbolName> names, std::uint32_t any,
                   RegularExpression& out)
      : text_(text), names_(names), any_(any), out_(out) {}

  void parse() {
    const Part all = alternatives();
    if (at_ < text_.size()) fail("a symbol, \"(\", \"[\" or \"|\"");
    out_.follow_[0] = all.first;
    out_.accepting_ = all.last | (all.empty ? 1 : 0);
  }

 private:
  /// The words of a part of the expression.
  struct Part {
    bool empty = true;           ///< one of them is empty
    States first = 0, last = 0;  ///< the states in which they begin and end
  };

  [[noreturn]] void fail(std::string_view allowed) const {
    throw std::invalid_argument(
        fmt::format("character {}: found {}; allowed: {}", at_ + 1,
                    at_ < text_.size() ? fmt::format("\"{}\"", text_[at_]) : "the end", allowed));
  }
  bool next_is(char c) const { return at_ < text_.size() && text_[at_] == c; }
  bool take(char c) {
    const bool found = next_is(c);
    at_ += found ? 1 : 0;
    return found;
  }

  Part alternatives() {
    Part all = sequence();
    while (take('|')) {
      const Part other = sequence();
      all = {all.empty || other.empty, all.first | other.first, all.last | other.last};
    }
    return all;
  }

  Part sequence() {
    Part all;
    while (at_ < text_.size() && !next_is('|') && !next_is(')')) {
      all = joined(all, repeated(text_.size()));
    }
    return all;
  }

  Part joined(const Part& a, const Part& b) {
    for_each_state(a.last, [&](std::size_t i) { out_.follow_[i] |= b.first; });
    return {a.empty && b.empty, a.first | (a.empty ? b.first : 0), b.last | (b.empty ? a.last : 0)};
  }

  /// A part with its repetitions, as far as they begin before `end`.
  Part repeated(std::size_t end) {
    const std::size_t begin = at_;
    Part part = atom();
    while (at_ < end) {
      if (take('*')) {
        joined(part, part);
        part.empty = true;
      } else if (take('+')) {
        joined(part, part);
      } else if (take('?')) {
        part.empty = true;
      } else if (next_is('{')) {
        part = counted(part, begin);
      } else {
        break;
      }
    }
    return part;
  }

  /// `once`, read from `begin` on, as often as the braces here say: reads it again for each copy.
  Part counted(Part once, std::size_t begin) {
    const std::size_t end = at_++;
    const int least = number();
    const bool range = take(',');
    const bool endless = range && next_is('}');
    const int most = !range ? least : endless ? std::max(1, least) : number();
    if (!take('}')) fail("\"}\"");
    if (most < least) {
      at_ = end;
      fail("a largest number of repetitions that is not below the least");
    }
    const std::size_t after = at_;
    Part all;
    for (int k = 1; k <= most; ++k) {
      at_ = begin;
      Part copy = k == 1 ? once : repeated(end);
      if (endless && k == most) joined(copy, copy);
      copy.empty = copy.empty || k > least;
      all = joined(all, copy);
    }
    at_ = after;
    return all;
  }

  int number() {
    int n = 0;
    const char* const first = text_.data() + at_;
    const auto read = std::from_chars(first, text_.data() + text_.size(), n);
    if (read.ec != std::errc() || n < 0) fail("a number");
    at_ += static_cast<std::size_t>(read.ptr - first);
    return n;
  }

  Part atom() {
    if (take('(')) {
      const Part group = alternatives();
      if (!take(')')) fail("\")\"");
      return group;
    }
    if (take('.')) return state(any_);
    if (!take('[')) return state(name());
    const bool others = take('^');
    std::uint32_t symbols = name();
    while (!take(']')) symbols |= name();
    return state(others ? any_ & ~symbols : symbols);
  }

  std::uint32_t name() {
    const SymbolName* longest = nullptr;
    for (const SymbolName& n : names_) {
      const bool found = text_.substr(at_).starts_with(n.name);
      if (found && (longest == nullptr || n.name.size() > longest->name.size())) longest = &n;
    }
    if (longest == nullptr) {
      std::string allowed;
      for (const SymbolName& n : names_) allowed += fmt::format("{}, ", n.name);
      fail(allowed + "or . for any of them but the ends");
    }
    at_ += longest->name.size();
    return longest->symbols;
  }

  Part state(std::uint32_t symbols) {
    const std::size_t i = out_.symbols_.size();
    if (i == RegularExpression::most_states) {
      throw std::invalid_argument(fmt::format(
          "character {}: the expression, with its repetitions written out, has more than {} "
          "symbols",
          at_, RegularExpression::most_states - 1));
    }
    out_.symbols_.push_back(symbols);
    out_.follow_.push_back(0);
    const States one = States{1} << i;
    return {false, one, one};
  }

  std::string_view text_;
  std::span<const SymbolName> names_;
  std::uint32_t any_;
  RegularExpression& out_;
  std::size_t at_ = 0;
};

RegularExpression::RegularExpression(std::string_view text, std::span<const SymbolName> names,
                                     std::uint32_t any)
    : symbols_(1), follow_(1) {
  ExpressionParser(text, names, any, *this).parse();
}

States RegularExpression::step(States before, int symbol) const {
  States reached = 0, after = 0;
  for_each_state(before, [&](std::size_t i) { reached |= follow_[i]; });
  for_each_state(reached, [&](std::size_t i) {
    if ((symbols_[i] >> symbol & 1) != 0) after |= States{1} << i;
  });
  return after;
}

States RegularExpression::step_back(States after, int symbol) const {
  States entered = 0, before = 0;
  for_each_state(after, [&](std::size_t i) {
    if ((symbols_[i] >> symbol & 1) != 0) entered |= States{1} << i;
  });
  for (std::size_t i = 0; i < follow_.size(); ++i) {
    if ((follow_[i] & entered) != 0) before |= States{1} << i;
  }
  return before;
}

RegularExpression RegularExpression::reversed() const {
  RegularExpression back;
  back.symbols_ = symbols_;
  back.follow_.assign(follow_.size(), 0);
  back.follow_[0] = accepting_ & ~States{1};
  back.accepting_ = accepting_ & 1;
  for (std::size_t i = 1; i < follow_.size(); ++i) {
    if ((follow_[0] >> i & 1) != 0) back.accepting_ |= States{1} << i;
    for_each_state(follow_[i], [&](std::size_t j) { back.follow_[j] |= States{1} << i; });
  }
  return back;
}

}  // namespace lacuna
