#pragma once

#include <variant>

namespace lacuna {

/// Whether the expected picture differs from the radiance of the scene. Biased settings have a
/// member `bool biased() const`.
template <class... Ts>
bool biased(const std::variant<Ts...>& settings) {
  return std::visit(
      []<class S>(const S& s) {
        if constexpr (requires { s.biased(); }) return s.biased();
        return false;
      },
      settings);
}

/// Whether the picture of biased settings converges to the radiance, because the bias of an
/// iteration vanishes with its index. Such settings have a member `bool consistent() const`.
template <class... Ts>
bool consistent(const std::variant<Ts...>& settings) {
  return std::visit(
      []<class S>(const S& s) {
        if constexpr (requires { s.consistent(); }) return s.consistent();
        return false;
      },
      settings);
}

}  // namespace lacuna
