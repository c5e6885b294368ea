#pragma once

#include <map>
#include <string>
#include <vector>

namespace lacuna {

/// A member of a settings struct that may be any JSON value, as one line of text. Equal numbers
/// have equal texts.
struct JsonValue {
  std::string text = "null";
  bool operator==(const JsonValue&) const = default;
  bool operator<(const JsonValue& o) const { return text < o.text; }
};

/// A member that is an object with arbitrary keys, in the order of the keys.
template <class T>
using JsonTable = std::map<std::string, T>;

template <class T>
inline constexpr bool is_table = false;
template <class T>
inline constexpr bool is_table<std::map<std::string, T>> = true;

}  // namespace lacuna
