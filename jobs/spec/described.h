#pragma once

#include <array>
#include <concepts>
#include <optional>
#include <string_view>
#include <type_traits>
#include <variant>
#include <vector>

#include "base/settings/field.h"
#include "jobs/spec/json_value.h"
#include "jobs/spec/name_or_object.h"

namespace lacuna {

/// Accepts any member: used by Described to detect a settings table.
struct ProbeVisitor {
  template <class T>
  void operator()(std::string_view, T&, const Field&) {}
};

/// A struct with a settings table (base/settings/field.h).
template <class T>
concept Described = requires(ProbeVisitor& v, T& settings) {
  describe(v, settings);
};

/// An enum with a table of names.
template <class T>
concept NamedEnum = std::is_enum_v<T> && requires {
  EnumTable<T>::values;
};

template <class T>
concept Integer = std::integral<T> && !std::same_as<T, bool>;

template <class T>
inline constexpr bool is_optional = false;
template <class T>
inline constexpr bool is_optional<std::optional<T>> = true;

template <class T>
inline constexpr bool is_array = false;
template <class T, std::size_t N>
inline constexpr bool is_array<std::array<T, N>> = true;

template <class T>
inline constexpr bool is_vector = false;
template <class T>
inline constexpr bool is_vector<std::vector<T>> = true;

template <class T>
inline constexpr bool is_variant = false;
template <class... Ts>
inline constexpr bool is_variant<std::variant<Ts...>> = true;

/// For static_assert in the last branch of a dispatch on types: unknown member types do not
/// compile.
template <class>
inline constexpr bool unsupported_type = false;

/// The key that names the alternative of a variant.
inline constexpr std::string_view variant_key = "type";

}  // namespace lacuna
