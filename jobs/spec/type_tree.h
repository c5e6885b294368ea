#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "jobs/spec/described.h"
#include "jobs/spec/json_writer.h"
#include "jobs/spec/limits.h"
#include "jobs/spec/published.h"

namespace lacuna {

struct Member;

/// A settings table as data, for the schema and the documentation.
struct Type {
  enum class Kind {
    boolean,
    integer,
    number,
    auto_number,
    string,
    name_or_object,
    word,
    word_or_object,
    array,
    list,
    object,
    choice,
    any,
    table
  };

  /// A value of an enum, or an alternative of a choice.
  struct Name {
    std::string_view name, doc;
  };

  Kind kind = Kind::boolean;
  bool optional = false;   ///< may be null or absent
  bool published = false;  ///< an object that may have `values_key`
  Limits limits = {};      ///< of a number; of the length of a string, name or list
  std::size_t array_size = 0;
  std::vector<Name> names;      ///< word, word_or_object, choice
  std::vector<Type> elements;   ///< array, list, table: one; choice: an object for each name
  std::vector<Member> members;  ///< object, or alternative to a name or word
};

/// One line of a table.
struct Member {
  std::string_view name;
  Field field;
  Type type;
  OrderedJson default_value;  ///< unless field.required
};

/// The visitor that turns tables into data.
class TypeReader {
 public:
  template <class T>
  void operator()(std::string_view name, const T& member, const Field& field) {
    members_.push_back({name, field, type_of(member, field), ObjectWriter::value_of(member)});
  }

  /// The type of a member with this field; `value` holds the defaults. Ranges hold for the elements
  /// of an array, lengths for a list itself.
  template <class T>
  static Type type_of(const T& value, const Field& field);

 private:
  template <class T>
  static Type object_of(T settings) {  // a copy: describe() takes a mutable reference
    TypeReader reader;
    describe(reader, settings);
    Type type;
    type.kind = Type::Kind::object;
    type.members = std::move(reader.members_);
    type.published = PublishedFinder::has<T>();
    return type;
  }
  template <class... Ts>
  static Type choice_of(const std::variant<Ts...>&) {
    Type type;
    type.kind = Type::Kind::choice;
    type.names = {Type::Name{Ts::name, Ts::doc}...};
    type.elements = {object_of(Ts{})...};
    return type;
  }

  std::vector<Member> members_;
};

template <class T>
Type TypeReader::type_of(const T& value, const Field& field) {
  Type type;
  if constexpr (std::is_same_v<T, bool>) {
    type.kind = Type::Kind::boolean;
  } else if constexpr (Integer<T>) {
    type.kind = Type::Kind::integer;
    type.limits = limits_of<T>(field);
  } else if constexpr (std::is_same_v<T, double>) {
    type.kind = Type::Kind::number;
    type.limits = limits_of<T>(field);
  } else if constexpr (std::is_same_v<T, AutoNumber>) {
    type.kind = Type::Kind::auto_number;
    type.limits = limits_of<double>(field);
  } else if constexpr (std::is_same_v<T, std::string>) {
    type.kind = Type::Kind::string;
    type.limits = length_limits(field);
  } else if constexpr (is_name_or<T>) {
    type = object_of(typename decltype(T::object)::value_type{});
    type.kind = Type::Kind::name_or_object;
    type.limits = length_limits(field);
  } else if constexpr (is_word_or<T>) {
    type = object_of(typename decltype(T::object)::value_type{});
    type.kind = Type::Kind::word_or_object;
    type.names = type_of(value.word, field).names;
  } else if constexpr (NamedEnum<T>) {
    type.kind = Type::Kind::word;
    for (const auto& v : EnumTable<T>::values) type.names.push_back({v.name, v.doc});
  } else if constexpr (is_optional<T>) {
    type = type_of(typename T::value_type{}, field);
    type.optional = true;
  } else if constexpr (is_array<T>) {
    type.kind = Type::Kind::array;
    type.array_size = std::tuple_size_v<T>;
    type.elements.push_back(type_of(typename T::value_type{}, field));
  } else if constexpr (is_vector<T>) {
    type.kind = Type::Kind::list;
    type.limits = length_limits(field);
    type.elements.push_back(type_of(typename T::value_type{}, Field{}));
  } else if constexpr (std::is_same_v<T, JsonValue>) {
    type.kind = Type::Kind::any;
  } else if constexpr (is_table<T>) {
    type.kind = Type::Kind::table;
    type.limits = length_limits(field);
    type.elements.push_back(type_of(typename T::mapped_type{}, Field{}));
  } else if constexpr (is_variant<T>) {
    type = choice_of(value);
  } else {
    static_assert(Described<T>, "no description for this type of member");
    type = object_of(value);
  }
  return type;
}

/// The JSON Schema of a type, as text.
std::string schema_text(const Type& type);

}  // namespace lacuna
