#pragma once

#include <optional>
#include <string_view>

namespace lacuna {

/// How a document says that a number is left to the method.
inline constexpr std::string_view auto_name = "auto";

/// A number in settings that the method may find by itself: a document holds a number within the
/// field's range, or "auto".
struct AutoNumber {
  std::optional<double> value;  ///< none: "auto"

  bool is_auto() const { return !value; }
  bool operator==(const AutoNumber&) const = default;
};

}  // namespace lacuna
