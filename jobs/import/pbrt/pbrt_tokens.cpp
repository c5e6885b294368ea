#include "jobs/import/pbrt/pbrt_tokens.h"

#include <fmt/format.h>

#include <algorithm>

#include "jobs/import/input_bytes.h"
#include "renderer/core/scene_error.h"

namespace lacuna::pbrt {

std::string Place::text() const { return fmt::format("{}:{}", file ? *file : "?", line); }

void fail(const Place& place, const std::string& message) {
  throw SceneError(fmt::format("{}: {}", place.text(), message));
}

Tokens::Tokens(const std::filesystem::path& file) : folder_(file.parent_path()) { open(file); }

void Tokens::open(const std::filesystem::path& file) {
  std::error_code none;
  const auto relative = std::filesystem::relative(file, folder_, none);
  contents_.push_back(read_unzipped(file, std::min(max_file_bytes, max_total_bytes - bytes_)));
  bytes_ += contents_.back().size();
  files_.push_back(
      {std::filesystem::weakly_canonical(file),
       std::make_shared<const std::string>((none || relative.empty() ? file : relative).string()),
       contents_.back()});
}

void Tokens::include(const std::filesystem::path& file, const Place& place) {
  if (files_.size() >= max_depth) {
    fail(place, fmt::format("includes are nested {} deep, which is the limit", max_depth));
  }
  const auto path = std::filesystem::weakly_canonical(file);
  const auto is_same = [&](const File& f) { return f.path == path; };
  if (std::any_of(files_.begin(), files_.end(), is_same)) {
    fail(place, fmt::format("\"{}\" includes itself", file.string()));
  }
  if (peeked_) fail(place, "internal: an include after a token that was looked at");
  try {
    open(file);
  } catch (const SceneError& e) {
    fail(place, e.what());
  }
}

std::optional<Token> Tokens::next() {
  if (peeked_) {
    peeked_ = false;
    return ahead_;
  }
  while (!files_.empty()) {
    if (auto token = scan(files_.back())) return token;
    files_.pop_back();
  }
  return std::nullopt;
}

const std::optional<Token>& Tokens::peek() {
  if (!peeked_) {
    ahead_ = next();
    peeked_ = true;
  }
  return ahead_;
}

std::optional<Token> Tokens::scan(File& file) {
  std::string_view& rest = file.rest;
  while (!rest.empty()) {
    const char c = rest.front();
    if (c == '#') {
      rest.remove_prefix(std::min(rest.find('\n'), rest.size()));
    } else if (c == ' ' || c == '\t' || c == '\r' || c == '\n') {
      if (c == '\n') ++file.line;
      rest.remove_prefix(1);
    } else {
      break;
    }
  }
  if (rest.empty()) return std::nullopt;
  Token token;
  token.place = {file.name, file.line};
  switch (rest.front()) {
    case '[':
    case ']':
      token.kind = rest.front() == '[' ? Token::Kind::open : Token::Kind::close;
      token.text = rest.substr(0, 1);
      rest.remove_prefix(1);
      return token;
    case '"':
      token.kind = Token::Kind::text;
      token.text = scan_text(file, token.place);
      return token;
    default:
      token.text = rest.substr(0, rest.find_first_of(" \t\r\n\"[]#"));
      rest.remove_prefix(token.text.size());
      return token;
  }
}

std::string_view Tokens::scan_text(File& file, const Place& place) {
  file.rest.remove_prefix(1);
  std::size_t end = 0;
  bool escaped = false;
  for (; end < file.rest.size() && file.rest[end] != '"'; ++end) {
    if (file.rest[end] == '\n') fail(place, "a text in quotes does not end on its line");
    if (file.rest[end] != '\\') continue;
    escaped = true;
    ++end;
  }
  if (end >= file.rest.size()) fail(place, "a text in quotes does not end");
  const std::string_view raw = file.rest.substr(0, end);
  file.rest.remove_prefix(end + 1);
  if (!escaped) return raw;
  std::string& text = unescaped_.emplace_back();
  for (std::size_t i = 0; i < raw.size(); ++i) {
    if (raw[i] != '\\') {
      text += raw[i];
      continue;
    }
    ++i;
    constexpr std::string_view names = "bfnrt\\'\"", values = "\b\f\n\r\t\\'\"";
    const auto which = names.find(raw[i]);
    if (which == std::string_view::npos) {
      fail(place, fmt::format("\"\\{}\" in a text; allowed after \\: {}", raw[i], names));
    }
    text += values[which];
  }
  return text;
}

}  // namespace lacuna::pbrt
