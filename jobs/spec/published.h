#pragma once

#include <array>
#include <string_view>
#include <variant>

#include "jobs/spec/described.h"

namespace lacuna {

/// The values of settings that a document leaves out.
enum class Values { defaults, published };

template <>
struct EnumTable<Values> {
  static constexpr std::array<EnumValue<Values>, 2> values{{
      {Values::defaults, "default", "the defaults"},
      {Values::published, "published",
       "the value in the paper where one is documented, else the default"},
  }};
};

/// The key of an object that selects these values for itself and for all objects below it that do
/// not have the key. Any object whose settings, or those below it, include one with a published
/// value (Field::published) may have it. It is not stored: the reader expands it.
inline constexpr std::string_view values_key = "as";
inline constexpr std::string_view values_doc =
    "the values of settings that are left out, here and below";

/// A visitor that finds published values.
class PublishedFinder {
 public:
  /// Whether `T`, or a setting below it, has one.
  template <class T>
  static bool has() {
    if constexpr (is_optional<T> || is_vector<T>) {
      return has<typename T::value_type>();
    } else if constexpr (is_variant<T>) {
      return any(static_cast<T*>(nullptr));
    } else if constexpr (Described<T>) {
      T settings{};
      PublishedFinder finder;
      describe(finder, settings);
      return finder.found_;
    } else {
      return false;
    }
  }

  template <class T>
  void operator()(std::string_view, T&, const Field& field) {
    found_ = found_ || !field.published.empty() || has<T>();
  }

 private:
  template <class... Ts>
  static bool any(std::variant<Ts...>*) {
    return (has<Ts>() || ...);
  }

  bool found_ = false;
};

}  // namespace lacuna
