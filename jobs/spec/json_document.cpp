#include "jobs/spec/json_document.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "base/json/json_cursor.h"

namespace lacuna {
namespace {

/// Line and column (from 1) of a byte, the surrounding text, and a caret below the byte. Each
/// character that is not printable ASCII becomes '?', so that the caret stays in its column.
std::string excerpt(std::string_view text, std::size_t byte) {
  constexpr std::size_t width = 30;
  byte = std::min(byte, text.size());
  const std::size_t newline = byte == 0 ? std::string_view::npos : text.rfind('\n', byte - 1);
  const std::size_t begin = newline == std::string_view::npos ? 0 : newline + 1;
  const std::size_t end = std::min(text.find('\n', byte), text.size());
  const auto line = 1 + std::count(text.begin(), text.begin() + std::ptrdiff_t(begin), '\n');

  const auto continues = [&](std::size_t i) { return (text[i] & 0xC0) == 0x80; };
  std::size_t column = 1, caret = 0;
  std::string shown;
  for (std::size_t i = begin; i < end; ++i) {
    if (continues(i)) continue;
    if (i < byte) ++column;
    if (i + width < byte || i > byte + width) continue;
    if (i < byte) ++caret;
    shown += text[i] >= 0x20 && text[i] < 0x7f ? text[i] : '?';
  }
  return fmt::format("line {}, column {}:\n{}\n{}^", line, column, shown, std::string(caret, ' '));
}

/// The parser's message without its tags, its position and the text it read.
std::string reason(std::string what) {
  if (const auto tag = what.find("] "); tag != std::string::npos) what.erase(0, tag + 2);
  if (what.starts_with("parse error")) {
    if (const auto colon = what.find(": "); colon != std::string::npos) what.erase(0, colon + 2);
  }
  if (const auto read = what.find("; last read: "); read != std::string::npos) {
    const auto expected = what.rfind("; expected ");
    const bool after = expected != std::string::npos && expected > read;
    what = what.substr(0, read) + (after ? what.substr(expected) : "");
  }
  what.resize(std::min<std::size_t>(what.size(), 200));
  for (char& c : what) {
    if (c < 0x20 || c > 0x7e) c = '?';
  }
  return what;
}

/// Builds the document from the parser's events, and stops if it is nested too deeply. The
/// library's own builder silently uses the last of duplicate keys.
class Builder final : public nlohmann::json_sax<Json> {
 public:
  Builder(std::string_view text, int max_depth, std::vector<Problem>& problems)
      : text_(text), max_depth_(max_depth), problems_(problems) {}

  Json take() { return std::move(root_); }
  const std::vector<Problem>& fatal() const { return fatal_; }

  bool null() override { return put(nullptr); }
  bool boolean(bool v) override { return put(v); }
  bool number_integer(number_integer_t v) override { return put(v); }
  bool number_unsigned(number_unsigned_t v) override { return put(v); }
  bool number_float(number_float_t v, const string_t&) override { return put(v); }
  bool string(string_t& v) override { return put(std::move(v)); }
  bool binary(binary_t&) override { return false; }  // not in JSON text
  bool start_object(std::size_t) override { return open(Json::object()); }
  bool start_array(std::size_t) override { return open(Json::array()); }
  bool end_object() override { return close(); }
  bool end_array() override { return close(); }

  bool key(string_t& name) override {
    Level& level = open_.back();
    level.key = std::move(name);
    if (level.value.contains(level.key)) {
      problems_.push_back({pointer(), "duplicate key; allowed: once"});
    }
    return true;
  }

  bool parse_error(std::size_t position, const std::string&,
                   const nlohmann::detail::exception& e) override {
    const std::size_t byte = position == 0 ? 0 : position - 1;
    fatal_.push_back({"", "malformed JSON: " + reason(e.what()) + " at " + excerpt(text_, byte)});
    return false;
  }

 private:
  struct Level {
    Json value;
    std::string key;
  };

  /// The pointer of the next value.
  std::string pointer() const {
    std::string at;
    for (const Level& level : open_) {
      const std::string index =
          level.value.is_array() ? std::to_string(level.value.size()) : level.key;
      at = child_pointer(at, index);
    }
    return at;
  }

  bool put(Json value) {
    if (open_.empty()) {
      root_ = std::move(value);
    } else if (Level& level = open_.back(); level.value.is_array()) {
      level.value.push_back(std::move(value));
    } else {
      level.value[level.key] = std::move(value);
    }
    return true;
  }

  bool open(Json empty) {
    if (std::cmp_greater_equal(open_.size(), max_depth_)) {
      fatal_.push_back({pointer(), fmt::format("nested too deeply; allowed: {} levels of objects "
                                               "and lists",
                                               max_depth_)});
      return false;
    }
    open_.push_back({std::move(empty), {}});
    return true;
  }

  bool close() {
    Json value = std::move(open_.back().value);
    open_.pop_back();
    return put(std::move(value));
  }

  std::string_view text_;
  int max_depth_;
  std::vector<Problem>& problems_;
  std::vector<Problem> fatal_;
  std::vector<Level> open_;
  Json root_;
};

}  // namespace

Json parse_document(std::string_view text, DocumentLimits limits, std::vector<Problem>& problems) {
  if (text.size() > limits.max_bytes) {
    throw BadJob({{"", fmt::format("the document has {} bytes; allowed: at most {}", text.size(),
                                   limits.max_bytes)}});
  }
  Builder builder(text, limits.max_depth, problems);
  if (!Json::sax_parse(text.begin(), text.end(), &builder)) throw BadJob(builder.fatal());
  return builder.take();
}

}  // namespace lacuna
