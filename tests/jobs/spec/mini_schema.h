#pragma once

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>

namespace lacuna {

/// Just enough of JSON Schema 2020-12 to judge documents by the schemas that Lacuna writes. Throws
/// on a keyword that it does not know, so that none goes unchecked.
class MiniSchema {
 public:
  using Json = nlohmann::json;

  static bool accepts(const Json& schema, const Json& value) {
    for (const auto& [keyword, rule] : schema.items()) {
      if (!holds(keyword, rule, schema, value)) return false;
    }
    return true;
  }

 private:
  static bool is_type(const std::string& type, const Json& v) {
    if (type == "null") return v.is_null();
    if (type == "boolean") return v.is_boolean();
    if (type == "string") return v.is_string();
    if (type == "array") return v.is_array();
    if (type == "object") return v.is_object();
    if (type == "number") return v.is_number();
    if (type == "integer") return v.is_number() && v.get<double>() == std::trunc(v.get<double>());
    throw std::logic_error("unknown type " + type);
  }

  static std::size_t length(const Json& v) {
    const auto& s = v.get_ref<const std::string&>();
    return std::size_t(
        std::count_if(s.begin(), s.end(), [](char c) { return (c & 0xC0) != 0x80; }));
  }

  static bool object_holds(const Json& schema, const Json& v) {
    for (const auto& key : schema["required"]) {
      if (!v.contains(key)) return false;
    }
    for (const auto& [key, member] : v.items()) {
      const auto it = schema["properties"].find(key);
      if (it == schema["properties"].end() || !accepts(*it, member)) return false;
    }
    return true;
  }

  static bool holds(const std::string& keyword, const Json& rule, const Json& schema,
                    const Json& v) {
    const auto is_note = [&](const char* note) { return keyword == note; };
    if (is_note("$schema") || is_note("title") || is_note("description") || is_note("default") ||
        is_note("required")) {
      return true;  // "required" is looked at with "properties"
    }
    if (keyword == "type") {
      if (rule.is_string()) return is_type(rule, v);
      return std::any_of(rule.begin(), rule.end(), [&](const Json& t) { return is_type(t, v); });
    }
    if (keyword == "const") return v == rule;
    if (keyword == "enum") return std::find(rule.begin(), rule.end(), v) != rule.end();
    if (keyword == "oneOf") {
      return 1 == std::count_if(rule.begin(), rule.end(),
                                [&](const Json& choice) { return accepts(choice, v); });
    }
    if (keyword == "minimum") return !v.is_number() || v.get<double>() >= rule.get<double>();
    if (keyword == "maximum") return !v.is_number() || v.get<double>() <= rule.get<double>();
    if (keyword == "exclusiveMinimum") {
      return !v.is_number() || v.get<double>() > rule.get<double>();
    }
    if (keyword == "minLength") return !v.is_string() || length(v) >= rule.get<std::size_t>();
    if (keyword == "maxLength") return !v.is_string() || length(v) <= rule.get<std::size_t>();
    if (keyword == "minItems") return !v.is_array() || v.size() >= rule.get<std::size_t>();
    if (keyword == "maxItems") return !v.is_array() || v.size() <= rule.get<std::size_t>();
    if (keyword == "items") {
      return !v.is_array() ||
             std::all_of(v.begin(), v.end(), [&](const Json& e) { return accepts(rule, e); });
    }
    if (keyword == "properties") return !v.is_object() || object_holds(schema, v);
    if (keyword == "additionalProperties" && rule == false)
      return true;  // object_holds() is strict
    throw std::logic_error("unknown keyword " + keyword);
  }
};

}  // namespace lacuna
