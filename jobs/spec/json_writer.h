#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <variant>

#include "base/json/json_text.h"
#include "base/settings/auto_number.h"
#include "jobs/spec/described.h"

namespace lacuna {

/// The writing visitor: an object with every key of the table, in its order.
class ObjectWriter {
 public:
  template <class T>
  void operator()(std::string_view key, const T& member, const Field&) {
    json_[std::string(key)] = value_of(member);
  }

  /// The JSON of a member: an empty optional is null, a variant is an object with its name under
  /// "type".
  template <class T>
  static OrderedJson value_of(const T& member);

  template <Described T>
  void write(T settings) {  // a copy: describe() takes a mutable reference
    describe(*this, settings);
  }

 private:
  OrderedJson json_ = OrderedJson::object();
};

template <class T>
OrderedJson ObjectWriter::value_of(const T& member) {
  if constexpr (NamedEnum<T>) {
    return enum_name(member);
  } else if constexpr (is_optional<T>) {
    return member ? value_of(*member) : OrderedJson();
  } else if constexpr (std::is_same_v<T, AutoNumber>) {
    return member.value ? OrderedJson(*member.value) : OrderedJson(auto_name);
  } else if constexpr (is_name_or<T>) {
    return member.object ? value_of(*member.object) : OrderedJson(member.name);
  } else if constexpr (is_word_or<T>) {
    return member.object ? value_of(*member.object) : value_of(member.word);
  } else if constexpr (is_array<T> || is_vector<T>) {
    OrderedJson list = OrderedJson::array();
    for (const auto& element : member) list.push_back(value_of(element));
    return list;
  } else if constexpr (std::is_same_v<T, JsonValue>) {
    return parse_own(member.text);
  } else if constexpr (is_table<T>) {
    OrderedJson table = OrderedJson::object();
    for (const auto& [key, value] : member) table[key] = value_of(value);
    return table;
  } else if constexpr (is_variant<T>) {
    return std::visit(
        [](const auto& alternative) {
          ObjectWriter writer;
          writer.json_[std::string(variant_key)] = alternative.name;
          writer.write(alternative);
          return writer.json_;
        },
        member);
  } else if constexpr (Described<T>) {
    ObjectWriter writer;
    writer.write(member);
    return writer.json_;
  } else {
    return OrderedJson(member);
  }
}

}  // namespace lacuna
