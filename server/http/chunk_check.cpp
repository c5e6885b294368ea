#include "server/http/chunk_check.h"

#include <algorithm>
#include <charconv>
#include <cstring>
#include <string_view>

#include "server/http/message.h"

namespace lacuna {
namespace {

constexpr std::size_t max_line_bytes = 256;
constexpr int max_trailers = 16;

}  // namespace

std::size_t ChunkCheck::pass(char* data, std::size_t size) {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < size && !complete();) {
    if (state_ == State::data) {
      const std::size_t n = std::min<std::uint64_t>(left_, size - i);
      std::memmove(data + kept, data + i, n);
      kept += n;
      i += n;
      left_ -= n;
      if (left_ == 0) state_ = State::data_end;
    } else if (const char c = data[i++]; passes(c)) {
      data[kept++] = c;
    }
  }
  return kept;
}

/// A byte of a line; whether the library gets it. Of the trailers it gets the empty line at their
/// end.
bool ChunkCheck::passes(char c) {
  const bool after_cr = !line_.empty() && line_.back() == '\r';
  if ((c == '\n') != after_cr || c == '\0' || line_.size() == max_line_bytes) {
    throw HttpError(400, "The chunks of the body are malformed.");
  }
  const bool kept = state_ != State::trailer || line_ == "\r" || (line_.empty() && c == '\r');
  if (after_cr) {
    line_.pop_back();
    end_line();
    line_.clear();
  } else {
    line_ += c;
  }
  return kept;
}

void ChunkCheck::end_line() {
  if (state_ == State::size) return begin_chunk();
  if (state_ == State::data_end) {
    if (!line_.empty()) throw HttpError(400, "A chunk of the body is longer than it says.");
    state_ = State::size;
  } else if (line_.empty()) {
    state_ = State::complete;
  } else if (++trailers_ > max_trailers) {
    throw HttpError(400, "Too many headers follow the body.");
  }
}

void ChunkCheck::begin_chunk() {
  const char* const end = line_.data() + line_.size();
  const auto [stop, error] = std::from_chars(line_.data(), end, left_, 16);
  const std::string_view rest(stop, static_cast<std::size_t>(end - stop));
  const std::size_t next = std::min(rest.find_first_not_of(" \t"), rest.size());
  if (error != std::errc() || left_ >> 60U != 0 ||
      (!rest.empty() && !rest.substr(next).starts_with(';'))) {
    throw HttpError(400, "The size of a chunk of the body is malformed.");
  }
  state_ = left_ > 0 ? State::data : State::trailer;
}

}  // namespace lacuna
