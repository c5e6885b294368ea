#pragma once

#include <fmt/format.h>

#include <string>
#include <string_view>
#include <type_traits>

#include "base/settings/field.h"

namespace lacuna {

/// Writes a settings struct as "resolution=128 method=fast", for an artefact's key: all fields,
/// including those with default values; numbers read back to the same value.
class SettingsText {
 public:
  template <class T>
  void operator()(std::string_view name, const T& value, const Field&) {
    if (!text_.empty()) text_ += ' ';
    if constexpr (std::is_enum_v<T>) {
      text_ += fmt::format("{}={}", name, enum_name(value));
    } else {
      static_assert(std::is_arithmetic_v<T>, "a key's settings are numbers and choices");
      text_ += fmt::format("{}={}", name, value);
    }
  }
  const std::string& text() const { return text_; }

 private:
  std::string text_;
};

template <class Settings>
std::string settings_text(Settings settings) {
  SettingsText visitor;
  describe(visitor, settings);
  return visitor.text();
}

}  // namespace lacuna
