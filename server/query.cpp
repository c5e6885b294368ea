#include "server/query.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <charconv>

#include "server/message.h"

namespace lacuna {
namespace {

int hex_digit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

/// Well-formed UTF-8 without control characters (below U+0020, U+007F to U+009F).
bool is_plain_text(std::string_view text) {
  for (std::size_t i = 0; i < text.size();) {
    const auto lead = static_cast<unsigned char>(text[i]);
    const std::size_t length = lead < 0x80   ? 1
                               : lead < 0xc2 ? 0
                               : lead < 0xe0 ? 2
                               : lead < 0xf0 ? 3
                               : lead < 0xf5 ? 4
                                             : 0;
    if (length == 0 || length > text.size() - i) return false;
    std::uint32_t point = length == 1 ? lead : lead & (0x7fU >> length);
    for (std::size_t k = 1; k < length; ++k) {
      const auto next = static_cast<unsigned char>(text[i + k]);
      if ((next & 0xc0U) != 0x80) return false;
      point = point << 6U | (next & 0x3fU);
    }
    const bool too_long = (length == 3 && point < 0x800) || (length == 4 && point < 0x10000);
    const bool surrogate = point >= 0xd800 && point < 0xe000;
    const bool control = point < 0x20 || (point >= 0x7f && point < 0xa0);
    if (too_long || surrogate || control || point > 0x10ffff) return false;
    i += length;
  }
  return true;
}

std::string decode(std::string_view text) {
  std::string result;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '+') {
      result += ' ';
    } else if (text[i] != '%') {
      result += text[i];
    } else {
      const int high = i + 1 < text.size() ? hex_digit(text[i + 1]) : -1;
      const int low = i + 2 < text.size() ? hex_digit(text[i + 2]) : -1;
      if (high < 0 || low < 0) {
        throw HttpError(400, "The query holds a % that two hexadecimal digits do not follow.");
      }
      result += static_cast<char>(16 * high + low);
      i += 2;
    }
  }
  if (!is_plain_text(result)) {
    throw HttpError(400, "The query holds what is no UTF-8 text, or a control character.");
  }
  return result;
}

}  // namespace

Query Query::parse(std::string_view text) {
  Query query;
  while (!text.empty()) {
    const std::string_view part = text.substr(0, text.find('&'));
    text.remove_prefix(std::min(text.size(), part.size() + 1));
    const std::size_t equals = std::min(part.find('='), part.size());
    const std::string name = decode(part.substr(0, equals));
    if (name.empty()) throw HttpError(400, "The query holds a parameter without a name.");
    const std::string value = decode(part.substr(std::min(equals + 1, part.size())));
    if (!query.values_.emplace(name, value).second) {
      throw HttpError(400, fmt::format("Query parameter \"{}\" stands more than once.", name));
    }
  }
  return query;
}

std::optional<std::string> Query::text(const std::string& name) const {
  const auto found = values_.find(name);
  if (found == values_.end()) return std::nullopt;
  return found->second;
}

std::optional<std::int64_t> Query::integer(const std::string& name, std::int64_t min,
                                           std::int64_t max) const {
  const auto digits = text(name);
  if (!digits) return std::nullopt;
  std::int64_t value = 0;
  const char* end = digits->data() + digits->size();
  const auto [stop, error] = std::from_chars(digits->data(), end, value);
  if (error != std::errc() || stop != end || value < min || value > max) {
    throw HttpError(400, fmt::format("Query parameter \"{}\" is \"{}\": it must be an integer from "
                                     "{} to {}.",
                                     name, *digits, min, max));
  }
  return value;
}

bool Query::flag(const std::string& name) const {
  const auto value = text(name);
  if (!value || *value == "0" || *value == "false") return false;
  if (*value == "1" || *value == "true") return true;
  throw HttpError(
      400, fmt::format("Query parameter \"{}\" is \"{}\": it must be 1 or 0.", name, *value));
}

void Query::check_known(const std::vector<std::string>& names) const {
  for (const auto& [name, value] : values_) {
    if (std::find(names.begin(), names.end(), name) != names.end()) continue;
    throw HttpError(
        400, fmt::format("unknown query parameter \"{}\"; known: {}", name,
                         names.empty() ? "none" : fmt::format("{}", fmt::join(names, ", "))));
  }
}

}  // namespace lacuna
