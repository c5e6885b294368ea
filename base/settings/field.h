#pragma once

#include <limits>
#include <string_view>

namespace lacuna {

/// The description of a settings field besides its name, type and default.
///
/// Every settings struct has member initialisers (the defaults) and one function
///
///     template <class V> void describe(V& v, PathSettings& s) {
///       v("max_depth", s.max_depth, {.doc = "longest path, in edges", .min = 1, .max = 128});
///     }
///
/// from which the JSON reader, the JSON writer, the schema and the settings pages follow
/// (jobs/spec). A struct that is one of several choices ({"type": NAME, ...}) also has
/// `static constexpr std::string_view name, doc`; the choice is a std::variant of such structs.
struct Field {
  std::string_view doc;
  double min =
      -std::numeric_limits<double>::infinity();  ///< inclusive; for strings and lists: length
  double max =
      std::numeric_limits<double>::infinity();  ///< inclusive; for strings and lists: length
  bool above_min = false;                       ///< `min` itself is not allowed
  bool required = false;                        ///< there is no default
  std::string_view unit = {};
  /// The value in the paper, as JSON, if the default differs from it.
  std::string_view published = {};
};

/// Name and one-line documentation of each value of an enum that appears in settings: specialise
/// with `static constexpr std::array<EnumValue<E>, N> values`, or rows that have more columns.
/// Names are defined nowhere else.
template <class E>
struct EnumTable;

template <class E>
struct EnumValue {
  E value;
  std::string_view name;
  std::string_view doc;
};

/// The name of an enum value in files and on the command line.
template <class E>
constexpr std::string_view enum_name(E e) {
  for (const auto& v : EnumTable<E>::values) {
    if (v.value == e) return v.name;
  }
  return "?";
}

}  // namespace lacuna
