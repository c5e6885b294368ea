#include "jobs/spec/json_reader.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "jobs/spec/nearest.h"

namespace lacuna {
namespace {

std::string choices(std::span<const std::string_view> names) {
  return fmt::format("\"{}\"", fmt::join(names, "\", \""));
}

/// Number of code points; the parser has checked the encoding.
std::size_t characters(std::string_view utf8) {
  return static_cast<std::size_t>(
      std::count_if(utf8.begin(), utf8.end(), [](char c) { return (c & 0xC0) != 0x80; }));
}

std::vector<std::string_view> listed(std::span<const std::string_view> names) {
  return {names.begin(), names.end()};
}

}  // namespace

std::optional<AutoNumber> read_auto_number(const JsonCursor& found, const Limits& limits) {
  const bool number = found.value().is_number() && limits.allow(found.value().get<double>());
  if (number) return AutoNumber{found.value().get<double>()};
  if (found.value().is_string() && found.value().get_ref<const std::string&>() == auto_name) {
    return AutoNumber{};
  }
  found.refuse(with_limits("a number", range_text(limits)) + fmt::format(", or \"{}\"", auto_name));
  return {};
}

std::optional<std::string> read_string(const JsonCursor& found, const Limits& length) {
  const std::string allowed = with_limits("a string", length_text(length, "characters"));
  if (!found.value().is_string()) {
    found.refuse(allowed);
    return {};
  }
  const auto& text = found.value().get_ref<const std::string&>();
  if (text.find('\0') != std::string::npos) {
    found.refuse(allowed + ", none of them U+0000");
    return {};
  }
  if (const std::size_t n = characters(text); !length.allow(static_cast<double>(n))) {
    found.add_problem(
        fmt::format("found {} ({} characters); allowed: {}", shown(found.value()), n, allowed));
    return {};
  }
  return text;
}

bool check_size(const JsonCursor& found, const Limits& size) {
  const bool good = size.allow(static_cast<double>(found.value().size()));
  if (!good) found.refuse(with_limits("an object", length_text(size, "keys")));
  return good;
}

std::string any_value(const JsonCursor& found) { return any_value(found.value()); }

std::string any_value(const Json& value) {
  // 4 and 4.0 are the same number and get the same text.
  const auto plain = [](const auto& self, const Json& any) -> Json {
    if (any.is_number_float()) {
      const double x = any.get<double>();
      if (x == std::trunc(x) && std::abs(x) <= max_exact_integer) {
        return static_cast<std::int64_t>(x);
      }
    }
    if (!any.is_structured()) return any;
    Json all = any;
    for (Json& part : all) part = self(self, part);
    return all;
  };
  return json_text(plain(plain, value));
}

void check_retired(const JsonCursor& found, const RetiredKey& key) {
  if (found.value() == parse_own_sorted(key.only)) return;
  found.add_problem(
      fmt::format("found {}, a setting of an earlier version: {}; allowed: {}, or no such key",
                  shown(found.value()), key.now, key.only));
}

void check_keys(const JsonCursor& found, const std::vector<std::string_view>& known) {
  for (const auto& [key, value] : found.value().items()) {
    if (std::find(known.begin(), known.end(), key) != known.end()) continue;
    const std::string hint = nearest_hint(key, known);
    found.add_problem(key, fmt::format("unknown key {}{}", in_quotes(key),
                                       hint.empty() ? "; allowed: " + choices(known) : hint));
  }
}

std::optional<std::size_t> read_name(const JsonCursor& found,
                                     std::span<const std::string_view> names) {
  if (!found.value().is_string()) {
    found.refuse(choices(names));
    return {};
  }
  const auto& word = found.value().get_ref<const std::string&>();
  const auto it = std::find(names.begin(), names.end(), word);
  if (it != names.end()) return static_cast<std::size_t>(it - names.begin());
  found.refuse(choices(names) + nearest_hint(word, listed(names)));
  return {};
}

std::optional<std::size_t> read_alternative(const JsonCursor& found,
                                            std::span<const std::string_view> names) {
  if (found.value().is_string()) return read_name(found, names);
  if (!found.value().is_object()) {
    found.refuse(fmt::format("an object with \"{}\", or one of {}", variant_key, choices(names)));
    return {};
  }
  if (const auto type = found.find(variant_key)) return read_name(*type, names);
  found.refuse_missing(variant_key, "one of " + choices(names));
  return {};
}

}  // namespace lacuna
