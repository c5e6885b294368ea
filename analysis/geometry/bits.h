#pragma once

#include <bit>
#include <concepts>

namespace lacuna {

/// Calls `visit(i)` for each bit i that is 1, ascending.
template <std::unsigned_integral Bits, class Visit>
void for_each_bit(Bits bits, Visit&& visit) {
  for (; bits != 0; bits &= bits - 1) visit(std::countr_zero(bits));
}

/// The same, descending.
template <std::unsigned_integral Bits, class Visit>
void for_each_bit_descending(Bits bits, Visit&& visit) {
  while (bits != 0) {
    const int highest = std::bit_width(bits) - 1;
    visit(highest);
    bits ^= Bits{1} << highest;
  }
}

}  // namespace lacuna
