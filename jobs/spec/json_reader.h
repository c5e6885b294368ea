#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "base/json/json_cursor.h"
#include "base/json/json_text.h"
#include "base/settings/auto_number.h"
#include "base/settings/retired_key.h"
#include "jobs/spec/described.h"
#include "jobs/spec/json_document.h"
#include "jobs/spec/limits.h"
#include "jobs/spec/problems.h"
#include "jobs/spec/published.h"

namespace lacuna {

/// Collects the problems of a reader in a list.
class ProblemList final : public JsonProblems {
 public:
  explicit ProblemList(std::vector<Problem>& problems) : problems_(problems) {}
  void add(const std::string& pointer, const std::string& message) override {
    problems_.push_back({pointer, message});
  }

 private:
  std::vector<Problem>& problems_;
};

// Types that JsonCursor does not read. Each adds a problem and returns none, or false, if the value
// is not allowed.
std::optional<AutoNumber> read_auto_number(const JsonCursor& found, const Limits& limits);
/// No U+0000; `length` in code points.
std::optional<std::string> read_string(const JsonCursor& found, const Limits& length);
/// Checks the number of keys of an object.
bool check_size(const JsonCursor& found, const Limits& size);
/// Any value, as one line of text.
std::string any_value(const JsonCursor& found);
std::string any_value(const Json& value);
/// Adds a problem for any value but the one allowed for a retired key.
void check_retired(const JsonCursor& found, const RetiredKey& key);
void check_keys(const JsonCursor& found, const std::vector<std::string_view>& known);
/// The index of the value in `names`.
std::optional<std::size_t> read_name(const JsonCursor& found,
                                     std::span<const std::string_view> names);
/// The index of the alternative that {"type": NAME, ...} or "NAME" selects.
std::optional<std::size_t> read_alternative(const JsonCursor& found,
                                            std::span<const std::string_view> names);

/// The reading visitor: fills settings from an object of a document. A missing key leaves the
/// member's default, or sets its published value (published.h); a problem is recorded and reading
/// continues.
class ObjectReader {
 public:
  /// `values`: of keys that are missing in `object` and below.
  ObjectReader(const JsonCursor& object, Values values) : object_(object), values_(values) {}

  template <class T>
  void operator()(std::string_view key, T& member, const Field& field) {
    known_.push_back(key);
    if (const auto found = object_.find(key)) {
      read_value(*found, member, field);
    } else if (field.required) {
      object_.refuse_missing(key, field.doc);
    } else if (values_ == Values::published) {
      read_published(member, field);
    }
  }

  /// Accepts a key that is not a member.
  void know(std::string_view key) { known_.push_back(key); }
  /// Accepts the keys that `T` had in earlier versions, with the values they may have.
  template <class T>
  void know_retired_keys() {
    if constexpr (requires { T::retired; }) {
      for (const RetiredKey& r : T::retired) {
        const auto found = object_.find(r.key);
        if (!found) continue;
        know(r.key);
        check_retired(*found, r);
      }
    }
  }
  void refuse_unknown_keys() const { check_keys(object_, known_); }
  /// Reads the key that selects `values` for `T`, if there is one.
  template <class T>
  void read_values_key() {
    static const bool selects = PublishedFinder::has<T>();
    if (!selects) return;
    know(values_key);
    if (const auto found = object_.find(values_key)) read_enum(*found, values_);
  }

  template <class T>
  void read_value(const JsonCursor& found, T& out, const Field& field) const;

 private:
  /// Sets the published values of a member that the object lacks.
  template <class T>
  void read_published(T& member, const Field& field) const {
    if (!field.published.empty()) {
      const Json value = parse_own_sorted(field.published);
      read_value(object_.in_place(value), member, field);
    } else if constexpr (is_variant<T>) {
      std::visit([&](auto& s) { read_published_members(s); }, member);
    } else if constexpr (Described<T>) {
      read_published_members(member);
    }
  }
  template <class T>
  void read_published_members(T& settings) const {
    const Json nothing = Json::object();
    const JsonCursor object = object_.in_place(nothing);
    ObjectReader reader(object, Values::published);
    describe(reader, settings);
  }
  template <class T, std::size_t N>
  void read_array(const JsonCursor& found, std::array<T, N>& out, const Field& field) const;
  template <class T>
  void read_list(const JsonCursor& found, std::vector<T>& out, const Field& field) const;
  template <class T>
  void read_name_or(const JsonCursor& found, NameOr<T>& out, const Field& field) const;
  template <class E, class T>
  void read_word_or(const JsonCursor& found, WordOr<E, T>& out) const;
  template <class T>
  void read_table(const JsonCursor& found, JsonTable<T>& out, const Field& field) const;
  template <class... Ts>
  void read_variant(const JsonCursor& found, std::variant<Ts...>& out) const;
  template <class E>
  static void read_enum(const JsonCursor& found, E& out);

  const JsonCursor& object_;
  Values values_;
  std::vector<std::string_view> known_;
};

/// Reads a described struct; `out` holds the defaults.
template <Described T>
void read_settings(const JsonCursor& found, T& out, Values values = Values::defaults) {
  if (!found.check_object()) return;
  ObjectReader reader(found, values);
  reader.read_values_key<T>();
  describe(reader, out);
  reader.know_retired_keys<T>();
  reader.refuse_unknown_keys();
}

template <Described T>
void read_settings(const Json& document, std::vector<Problem>& problems, T& out) {
  ProblemList list(problems);
  read_settings(JsonCursor(document, "", list), out);
}

template <class T>
void ObjectReader::read_value(const JsonCursor& found, T& out, const Field& field) const {
  if constexpr (std::is_same_v<T, bool>) {
    if (const auto v = found.boolean()) out = *v;
  } else if constexpr (Integer<T>) {
    if (const auto v = found.integer(limits_of<T>(field))) out = static_cast<T>(*v);
  } else if constexpr (std::is_same_v<T, double>) {
    if (const auto v = found.number(limits_of<T>(field))) out = *v;
  } else if constexpr (std::is_same_v<T, AutoNumber>) {
    if (const auto v = read_auto_number(found, limits_of<double>(field))) out = *v;
  } else if constexpr (std::is_same_v<T, std::string>) {
    if (auto v = read_string(found, length_limits(field))) out = std::move(*v);
  } else if constexpr (NamedEnum<T>) {
    read_enum(found, out);
  } else if constexpr (is_optional<T>) {
    if (found.value().is_null()) {
      out.reset();
    } else {
      read_value(found, out.emplace(), field);
    }
  } else if constexpr (std::is_same_v<T, JsonValue>) {
    out.text = any_value(found);
  } else if constexpr (is_table<T>) {
    read_table(found, out, field);
  } else if constexpr (is_name_or<T>) {
    read_name_or(found, out, field);
  } else if constexpr (is_word_or<T>) {
    read_word_or(found, out);
  } else if constexpr (is_array<T>) {
    read_array(found, out, field);
  } else if constexpr (is_vector<T>) {
    read_list(found, out, field);
  } else if constexpr (is_variant<T>) {
    read_variant(found, out);
  } else if constexpr (Described<T>) {
    read_settings(found, out, values_);
  } else {
    static_assert(unsupported_type<T>, "no reader for this type of member");
  }
}

template <class T, std::size_t N>
void ObjectReader::read_array(const JsonCursor& found, std::array<T, N>& out,
                              const Field& field) const {
  if (!found.check_list_of(N)) return;
  for (std::size_t i = 0; i < N; ++i) {
    read_value(found.at(i), out[i], field);
  }
}

template <class T>
void ObjectReader::read_list(const JsonCursor& found, std::vector<T>& out,
                             const Field& field) const {
  if (!found.check_list(length_limits(field))) return;
  out.clear();
  for (std::size_t i = 0; i < found.value().size(); ++i) {
    T element{};
    read_value(found.at(i), element, Field{});
    out.push_back(std::move(element));
  }
}

template <class T>
void ObjectReader::read_name_or(const JsonCursor& found, NameOr<T>& out, const Field& field) const {
  if (found.value().is_object()) {
    read_settings(found, out.object.emplace(), values_);
  } else if (found.value().is_string()) {
    read_value(found, out.name, field);
  } else {
    found.refuse("a name, or an object");
  }
}

template <class E, class T>
void ObjectReader::read_word_or(const JsonCursor& found, WordOr<E, T>& out) const {
  if (found.value().is_object()) {
    read_settings(found, out.object.emplace(), values_);
  } else {
    read_enum(found, out.word);
  }
}

template <class T>
void ObjectReader::read_table(const JsonCursor& found, JsonTable<T>& out,
                              const Field& field) const {
  if (!found.check_object() || !check_size(found, length_limits(field))) return;
  out.clear();
  for (const auto& [key, value] : found.value().items()) {
    read_value(found.at(key), out[key], Field{});
  }
}

template <class... Ts>
void ObjectReader::read_variant(const JsonCursor& found, std::variant<Ts...>& out) const {
  static constexpr std::array<std::string_view, sizeof...(Ts)> names{Ts::name...};
  const auto chosen = read_alternative(found, names);
  if (!chosen) return;
  const Json nothing = Json::object();
  const JsonCursor object = found.in_place(found.value().is_string() ? nothing : found.value());
  const auto read_as = [&]<class T>(T settings) {
    ObjectReader reader(object, values_);
    reader.know(variant_key);
    reader.read_values_key<T>();
    describe(reader, settings);
    reader.know_retired_keys<T>();
    reader.refuse_unknown_keys();
    out = std::move(settings);
  };
  std::size_t i = 0;
  ((i++ == *chosen ? read_as(Ts{}) : void()), ...);
}

template <class E>
void ObjectReader::read_enum(const JsonCursor& found, E& out) {
  constexpr auto& values = EnumTable<E>::values;
  static constexpr auto names = [] {
    std::array<std::string_view, EnumTable<E>::values.size()> all;
    for (std::size_t i = 0; i < all.size(); ++i) all[i] = EnumTable<E>::values[i].name;
    return all;
  }();
  if (const auto i = read_name(found, names)) out = values[*i].value;
}

}  // namespace lacuna
