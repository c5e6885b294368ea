#include "base/json/json_cursor.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

namespace lacuna {

std::string child_pointer(const std::string& base, std::string_view key) {
  std::string at = base + '/';
  for (const char c : key) {
    if (c == '~') {
      at += "~0";
    } else if (c == '/') {
      at += "~1";
    } else {
      at += c;
    }
  }
  return at;
}

std::string in_quotes(std::string_view text) {
  constexpr std::size_t longest = 60;
  std::string quoted = json_text(Json(text.substr(0, longest)), Escape::all_but_ascii);
  if (text.size() > longest) quoted += "...";
  return quoted;
}

std::string shown(const Json& value) {
  switch (value.type()) {
    case Json::value_t::string:
      return "string " + in_quotes(value.get_ref<const std::string&>());
    case Json::value_t::object:
      return "an object";
    case Json::value_t::array:
      return fmt::format("a list of {}", value.size());
    case Json::value_t::number_integer:
    case Json::value_t::number_unsigned:
    case Json::value_t::number_float:
      return "number " + json_text(value);
    default:
      return json_text(value);
  }
}

std::string with_limits(std::string_view thing, const std::string& limits) {
  return limits.empty() ? std::string(thing) : fmt::format("{} {}", thing, limits);
}

JsonCursor JsonCursor::at(std::string_view key) const {
  return {*value_->find(key), child_pointer(pointer_, key), *problems_};
}

JsonCursor JsonCursor::at(std::size_t index) const {
  return {(*value_)[index], fmt::format("{}/{}", pointer_, index), *problems_};
}

std::optional<JsonCursor> JsonCursor::find(std::string_view key) const {
  const auto member = value_->find(key);
  if (member == value_->end()) return std::nullopt;
  return JsonCursor{*member, child_pointer(pointer_, key), *problems_};
}

std::optional<bool> JsonCursor::boolean() const {
  if (value_->is_boolean()) return value_->get<bool>();
  refuse("true or false");
  return {};
}

std::optional<double> JsonCursor::number(const Limits& limits) const {
  // JSON has no NaN, and the parser refuses numbers beyond double's range: every number is finite.
  if (value_->is_number() && limits.allow(value_->get<double>())) return value_->get<double>();
  refuse(with_limits("a number", range_text(limits)));
  return {};
}

std::optional<std::int64_t> JsonCursor::integer(const Limits& limits) const {
  if (value_->is_number()) {
    // A double represents every allowed integer exactly.
    const double x = value_->get<double>();
    if (x == std::trunc(x) && limits.allow(x)) return static_cast<std::int64_t>(x);
  }
  refuse(with_limits("an integer", range_text(limits)));
  return {};
}

std::optional<std::uint64_t> JsonCursor::digits(const Limits& limits) const {
  // The library would turn -1 into 2^64-1 and 1.9 into 1.
  if (value_->is_number_unsigned() && limits.allow(value_->get<double>())) {
    return value_->get<std::uint64_t>();
  }
  refuse(with_limits("an integer", range_text(limits)));
  return {};
}

std::optional<std::string> JsonCursor::string() const {
  if (value_->is_string()) return value_->get<std::string>();
  refuse("a string");
  return {};
}

bool JsonCursor::check_object() const {
  if (!value_->is_object()) refuse("an object");
  return value_->is_object();
}

bool JsonCursor::check_list(const Limits& length) const {
  const bool good = value_->is_array() && length.allow(static_cast<double>(value_->size()));
  if (!good) refuse(with_limits("a list", length_text(length, "elements")));
  return good;
}

bool JsonCursor::check_list_of(std::size_t size) const {
  const bool good = value_->is_array() && value_->size() == size;
  if (!good) refuse(fmt::format("a list of exactly {}", size));
  return good;
}

void JsonCursor::refuse(const std::string& allowed) const {
  add_problem(fmt::format("found {}; allowed: {}", shown(*value_), allowed));
}

void JsonCursor::refuse_missing(std::string_view key, std::string_view required) const {
  add_problem(key, fmt::format("missing; required: {}", required));
}

void JsonCursor::add_problem(std::string_view key, const std::string& message) const {
  problems_->add(child_pointer(pointer_, key), message);
}

}  // namespace lacuna
