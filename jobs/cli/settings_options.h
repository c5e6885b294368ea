#pragma once

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>
#include <string>
#include <type_traits>

#include "base/settings/field.h"

namespace lacuna {

/// Adds an option --NAME to a command for each field of a settings struct, with - for _.
class SettingsOptions {
 public:
  explicit SettingsOptions(CLI::App& command) : command_(command) {}

  template <class T>
  void operator()(std::string_view name, T& value, const Field& field) {
    std::string option = "--" + std::string(name);
    std::replace(option.begin(), option.end(), '_', '-');
    const std::string doc(field.doc);
    if constexpr (std::is_enum_v<T>) {
      std::map<std::string, T> values;
      std::string names;
      for (const auto& v : EnumTable<T>::values) {
        values.emplace(v.name, v.value);
        names.append(names.empty() ? "" : "|").append(v.name);
      }
      command_.add_option(option, value, doc)
          ->transform(CLI::CheckedTransformer(values).description(""))
          ->type_name(names)
          ->default_str(std::string(enum_name(value)));
    } else {
      static_assert(std::is_arithmetic_v<T> && !std::is_same_v<T, bool>,
                    "no option for this type of member");
      CLI::Option* const added =
          command_.add_option(option, value, doc)
              ->check(CLI::Range(static_cast<T>(field.min), static_cast<T>(field.max)))
              ->capture_default_str();
      if constexpr (std::is_floating_point_v<T>) {
        added->check([](const std::string& text) {  // a NaN lies in every CLI::Range
          return std::isnan(std::strtod(text.c_str(), nullptr)) ? text + " is not a number"
                                                                : std::string();
        });
      }
    }
  }

 private:
  CLI::App& command_;
};

}  // namespace lacuna
