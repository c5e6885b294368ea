#pragma once

#include <array>
#include <stdexcept>
#include <string>
#include <string_view>

#include "base/automaton/two_sided_automaton.h"

namespace lacuna {

/// The letters of light paths: Heckbert's (1990, "Adaptive radiosity textures for bidirectional ray
/// tracing") for the eye, an emitter, and what a path does at each vertex between them; G and the
/// two sides as in light path expressions of production renderers.
enum class PathSymbol : std::uint8_t {
  diffuse_reflected,
  diffuse_transmitted,
  glossy_reflected,
  glossy_transmitted,
  specular_reflected,
  specular_transmitted,
  light,
  eye
};
inline constexpr int scattering_symbols = 6;

constexpr std::uint32_t bit_of(PathSymbol s) { return std::uint32_t{1} << static_cast<int>(s); }

/// The names of letters in expressions.
inline constexpr std::array<SymbolName, 18> path_symbol_names{{
    {"E", bit_of(PathSymbol::eye)},
    {"C", bit_of(PathSymbol::eye)},
    {"L", bit_of(PathSymbol::light)},
    {"D", 0b000011},
    {"G", 0b001100},
    {"S", 0b110000},
    {"<.D>", 0b000011},
    {"<.G>", 0b001100},
    {"<.S>", 0b110000},
    {"<..>", 0b111111},
    {"<RD>", 0b000001},
    {"<RG>", 0b000100},
    {"<RS>", 0b010000},
    {"<R.>", 0b010101},
    {"<TD>", 0b000010},
    {"<TG>", 0b001000},
    {"<TS>", 0b100000},
    {"<T.>", 0b101010},
}};

/// An expression over the letters of whole paths, from the eye to the light.
using PathExpression = MatchedWords;

/// Reads an expression, which `!` negates. It begins with E and ends with L, or the reverse: then
/// its words are read from the light, as Heckbert writes them. Throws std::invalid_argument.
inline PathExpression path_expression(std::string_view text) {
  const bool others = text.starts_with('!');
  RegularExpression all(text.substr(others ? 1 : 0), path_symbol_names,
                        (std::uint32_t{1} << scattering_symbols) - 1);
  const auto between = [&](PathSymbol first, PathSymbol last) {
    if ((all.accepting() & 1) != 0 || all.accepting() == 0) return false;
    for (std::size_t i = 1; i < all.states(); ++i) {
      const bool begins = (all.follow(0) >> i & 1) != 0, ends = (all.accepting() >> i & 1) != 0;
      if (begins != (all.symbols(i) == bit_of(first))) return false;
      if (ends != (all.symbols(i) == bit_of(last))) return false;
    }
    return true;
  };
  if (between(PathSymbol::eye, PathSymbol::light)) return {all, others};
  if (between(PathSymbol::light, PathSymbol::eye)) return {all.reversed(), others};
  throw std::invalid_argument(
      "found other letters at its ends, or E or L between them; allowed: words that begin with E "
      "(or C), at the eye, and end with L, on an emitter, or the reverse, like E[DG]+L or LS+DE");
}

/// The automaton of some expressions, which reads paths from both ends. Throws std::length_error if
/// it has too many states.
inline TwoSidedAutomaton path_automaton(std::span<const PathExpression> expressions) {
  return {expressions, scattering_symbols, static_cast<int>(PathSymbol::eye),
          static_cast<int>(PathSymbol::light)};
}

}  // namespace lacuna
