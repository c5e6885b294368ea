#include "server/http/query.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>

#include "base/json/json_text.h"
#include "server/http/message.h"

namespace lacuna {
namespace {

/// Well-formed UTF-8 without control characters (below U+0020, U+007F to U+009F).
bool is_plain_text(const std::string& text) {
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto byte = [&](std::size_t k) { return k < text.size() ? text[k] & 0xff : 0; };
    const bool of_two_bytes = byte(i) == 0xc2 && byte(i + 1) < 0xa0;
    if (byte(i) < 0x20 || byte(i) == 0x7f || of_two_bytes) return false;
  }
  return is_utf8(text);
}

std::string decoded(std::string_view sent) {
  std::string text;
  for (std::size_t i = 0; i < sent.size(); ++i) {
    if (sent[i] != '%') {
      text += sent[i] == '+' ? ' ' : sent[i];
      continue;
    }
    unsigned char byte = 0;
    const std::string_view digits = sent.substr(i + 1, 2);
    const char* const end = digits.data() + digits.size();
    if (digits.size() < 2 || std::from_chars(digits.data(), end, byte, 16).ptr != end) {
      throw HttpError(400, "The query contains a % without two hexadecimal digits.");
    }
    text += static_cast<char>(byte);
    i += digits.size();
  }
  if (!is_plain_text(text)) {
    throw HttpError(400, "The query contains invalid UTF-8 or a control character.");
  }
  return text;
}

}  // namespace

Query::Query(std::string_view sent) {
  while (!sent.empty()) {
    const std::string_view part = sent.substr(0, sent.find('&'));
    const std::size_t equals = std::min(part.find('='), part.size());
    if (equals == 0) throw HttpError(400, "The query contains a parameter without a name.");
    if (part.find('=', equals + 1) != std::string_view::npos) {
      throw HttpError(400, "The query contains a second \"=\" in a parameter: write it as %3D.");
    }
    const std::string name = decoded(part.substr(0, equals));
    const bool has_value = equals < part.size();
    if (!values_.emplace(name, has_value ? decoded(part.substr(equals + 1)) : "").second) {
      throw HttpError(400, fmt::format("Query parameter \"{}\" is repeated.", name));
    }
    sent.remove_prefix(std::min(sent.size(), part.size() + 1));
  }
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
