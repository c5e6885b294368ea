#pragma once

#include <compare>
#include <map>
#include <string>
#include <vector>

namespace lacuna {

/// A member of a settings struct that may be any JSON value, as one line of text: numbers that are
/// equal are the same text.
struct JsonValue {
  std::string text = "null";
  auto operator<=>(const JsonValue&) const = default;
};

/// A member that is an object whose keys are not known beforehand, in the order of the keys.
template <class T>
using JsonTable = std::map<std::string, T>;

template <class T>
inline constexpr bool is_table = false;
template <class T>
inline constexpr bool is_table<std::map<std::string, T>> = true;

}  // namespace lacuna
