#pragma once

#include <optional>
#include <string_view>

namespace lacuna {

/// The value in a document for a number that the method determines itself.
inline constexpr std::string_view auto_name = "auto";

/// A number in settings that the method can determine itself: a document contains a number within
/// the field's range, or "auto".
struct AutoNumber {
  std::optional<double> value;  ///< none: "auto"

  bool is_auto() const { return !value; }
  bool operator==(const AutoNumber&) const = default;
};

}  // namespace lacuna
