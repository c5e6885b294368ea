#include "jobs/spec/json_reader.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "jobs/spec/nearest.h"

namespace lacuna {
namespace {

/// A string as it would stand in JSON, in printable ASCII, cut where it is long.
std::string in_quotes(std::string_view text) {
  constexpr std::size_t longest = 60;
  std::string shown = json_text(Json(text.substr(0, longest)), Escape::all_but_ascii);
  if (text.size() > longest) shown += "...";
  return shown;
}

/// The type and value of what was found.
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

std::string with(std::string_view thing, const std::string& limits) {
  return limits.empty() ? std::string(thing) : fmt::format("{} {}", thing, limits);
}

std::string choices(std::span<const std::string_view> names) {
  return fmt::format("\"{}\"", fmt::join(names, "\", \""));
}

/// Code points; the parser has checked the encoding.
std::size_t characters(std::string_view utf8) {
  return static_cast<std::size_t>(
      std::count_if(utf8.begin(), utf8.end(), [](char c) { return (c & 0xC0) != 0x80; }));
}

std::vector<std::string_view> listed(std::span<const std::string_view> names) {
  return {names.begin(), names.end()};
}

}  // namespace

void Found::refuse(const std::string& allowed) const {
  add_problem(fmt::format("found {}; allowed: {}", shown(value), allowed));
}

std::optional<std::int64_t> read_integer(const Found& found, const Limits& limits) {
  const std::string allowed = with("an integer", range_text(limits));
  if (!found.value.is_number()) {
    found.refuse(allowed);
    return {};
  }
  // A double holds every integer that the limits allow, and 512.0 or 1e3 are integers too.
  const double value = found.value.get<double>();
  if (value != std::trunc(value) || !limits.allow(value)) {
    found.refuse(allowed);
    return {};
  }
  return static_cast<std::int64_t>(value);
}

std::optional<double> read_number(const Found& found, const Limits& limits) {
  if (!found.value.is_number() || !limits.allow(found.value.get<double>())) {
    found.refuse(with("a number", range_text(limits)));
    return {};
  }
  return found.value.get<double>();
}

std::optional<AutoNumber> read_auto_number(const Found& found, const Limits& limits) {
  const bool number = found.value.is_number() && limits.allow(found.value.get<double>());
  if (number) return AutoNumber{found.value.get<double>()};
  if (found.value.is_string() && found.value.get_ref<const std::string&>() == auto_name) {
    return AutoNumber{};
  }
  found.refuse(with("a number", range_text(limits)) + fmt::format(", or \"{}\"", auto_name));
  return {};
}

std::optional<std::string> read_string(const Found& found, const Limits& length) {
  const std::string allowed = with("a string", length_text(length, "characters"));
  if (!found.value.is_string()) {
    found.refuse(allowed);
    return {};
  }
  const auto& text = found.value.get_ref<const std::string&>();
  if (text.find('\0') != std::string::npos) {
    found.refuse(allowed + ", none of them U+0000");
    return {};
  }
  if (const std::size_t n = characters(text); !length.allow(static_cast<double>(n))) {
    found.add_problem(
        fmt::format("found {} ({} characters); allowed: {}", shown(found.value), n, allowed));
    return {};
  }
  return text;
}

bool check_object(const Found& found) {
  if (!found.value.is_object()) found.refuse("an object");
  return found.value.is_object();
}

bool check_list(const Found& found, const Limits& length) {
  const bool good = found.value.is_array() && length.allow(static_cast<double>(found.value.size()));
  if (!good) found.refuse(with("a list", length_text(length, "elements")));
  return good;
}

bool check_size(const Found& found, const Limits& size) {
  const bool good = size.allow(static_cast<double>(found.value.size()));
  if (!good) found.refuse(with("an object", length_text(size, "keys")));
  return good;
}

std::string any_value(const Found& found) {
  // 4 and 4.0 are one number, and so is its text.
  const auto plain = [](const auto& self, const Json& value) -> Json {
    if (value.is_number_float()) {
      const double x = value.get<double>();
      if (x == std::trunc(x) && std::abs(x) <= max_exact_integer) {
        return static_cast<std::int64_t>(x);
      }
    }
    if (!value.is_structured()) return value;
    Json all = value;
    for (Json& part : all) part = self(self, part);
    return all;
  };
  return json_text(plain(plain, found.value));
}

bool check_array(const Found& found, std::size_t size) {
  const bool good = found.value.is_array() && found.value.size() == size;
  if (!good) found.refuse(fmt::format("a list of exactly {}", size));
  return good;
}

void check_keys(const Found& found, const std::vector<std::string_view>& known) {
  for (const auto& [key, value] : found.value.items()) {
    if (std::find(known.begin(), known.end(), key) != known.end()) continue;
    const std::string hint = nearest_hint(key, known);
    found.child(key, value)
        .add_problem(fmt::format("unknown key {}{}", in_quotes(key),
                                 hint.empty() ? "; allowed: " + choices(known) : hint));
  }
}

std::optional<std::size_t> read_name(const Found& found, std::span<const std::string_view> names) {
  if (!found.value.is_string()) {
    found.refuse(choices(names));
    return {};
  }
  const auto& word = found.value.get_ref<const std::string&>();
  const auto it = std::find(names.begin(), names.end(), word);
  if (it != names.end()) return static_cast<std::size_t>(it - names.begin());
  found.refuse(choices(names) + nearest_hint(word, listed(names)));
  return {};
}

std::optional<std::size_t> read_alternative(const Found& found,
                                            std::span<const std::string_view> names) {
  if (found.value.is_string()) return read_name(found, names);
  if (!found.value.is_object()) {
    found.refuse(fmt::format("an object with \"{}\", or one of {}", variant_key, choices(names)));
    return {};
  }
  const auto it = found.value.find(variant_key);
  if (it != found.value.end()) return read_name(found.child(variant_key, *it), names);
  found.child(variant_key, found.value)
      .add_problem(fmt::format("missing; required: one of {}", choices(names)));
  return {};
}

void refuse_missing(const Found& parent, std::string_view key, const Field& field) {
  parent.child(key, parent.value).add_problem(fmt::format("missing; required: {}", field.doc));
}

}  // namespace lacuna
