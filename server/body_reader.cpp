#include "server/body_reader.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <system_error>

namespace lacuna {
namespace {

constexpr std::size_t max_line_bytes = 256;
constexpr int max_trailers = 16;

HttpError too_large(std::uint64_t max_bytes) {
  return HttpError(413, fmt::format("The body is larger than {} bytes.", max_bytes));
}

}  // namespace

std::size_t TextSource::read(char* data, std::size_t size) {
  const std::size_t n = std::min(size, text_.size());
  std::memcpy(data, text_.data(), n);
  text_.remove_prefix(n);
  return n;
}

std::string BodyReader::text(std::size_t max_bytes) {
  std::string body;
  read(ByteSource::Pace::total, max_bytes,
       [&](const char* data, std::size_t size) { body.append(data, size); });
  return body;
}

std::uint64_t BodyReader::to_file(int fd, std::uint64_t max_bytes) {
  std::uint64_t total = 0;
  read(ByteSource::Pace::rate, max_bytes, [&](const char* data, std::size_t size) {
    for (std::size_t done = 0; done < size;) {
      const ssize_t n = ::write(fd, data + done, size - done);
      if (n < 0 && errno == EINTR) continue;
      if (n <= 0) throw std::system_error(errno, std::generic_category(), "cannot store a body");
      done += static_cast<std::size_t>(n);
    }
    total += size;
  });
  return total;
}

template <class Sink>
void BodyReader::read(ByteSource::Pace pace, std::uint64_t max_bytes, const Sink& sink) {
  if (single_header(head_.headers, "content-encoding")) {
    throw HttpError(415, "An encoded body (Content-Encoding) is not accepted.");
  }
  if (complete_) return;
  if (framing_.length > max_bytes) throw too_large(max_bytes);
  source_.begin_body(pace);
  if (framing_.chunked) {
    read_chunks(max_bytes, sink);
  } else {
    pass_on(framing_.length, sink);
  }
  complete_ = true;
  source_.end_body();
}

template <class Sink>
void BodyReader::read_chunks(std::uint64_t max_bytes, const Sink& sink) {
  // The smallest chunks carry one byte in six: "1\r\nx\r\n".
  lines_left_ = 7 * max_bytes + 4096;
  while (const std::uint64_t size = chunk_size()) {
    if (size > max_bytes) throw too_large(max_bytes);
    max_bytes -= size;
    pass_on(size, sink);
    if (!line().empty()) throw HttpError(400, "A chunk of the body is longer than it says.");
  }
  for (int trailers = 0; !line().empty(); ++trailers) {
    if (trailers == max_trailers) throw HttpError(400, "Too many headers follow the body.");
  }
}

template <class Sink>
void BodyReader::pass_on(std::uint64_t bytes, const Sink& sink) {
  while (bytes > 0) {
    fill();
    const auto n = static_cast<std::size_t>(std::min<std::uint64_t>(bytes, filled_ - taken_));
    sink(buffer_.data() + taken_, n);
    taken_ += n;
    bytes -= n;
  }
}

/// The next line, without its CR LF.
std::string BodyReader::line() {
  std::string result;
  for (;;) {
    fill();
    const char c = buffer_[taken_++];
    if (lines_left_ == 0) throw HttpError(400, "The chunks of the body are too small.");
    --lines_left_;
    if (c == '\n' && !result.empty() && result.back() == '\r') break;
    const bool bare = !result.empty() && result.back() == '\r';
    if (bare || c == '\n' || c == '\0' || result.size() == max_line_bytes) {
      throw HttpError(400, "The chunks of the body are malformed.");
    }
    result += c;
  }
  result.pop_back();
  return result;
}

std::uint64_t BodyReader::chunk_size() {
  const std::string text = line();
  std::uint64_t size = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), size, 16);
  const std::string_view rest(end, text.data() + text.size() - end);
  const std::size_t next = std::min(rest.find_first_not_of(" \t"), rest.size());
  if (error != std::errc() || size >> 60U != 0 ||
      (!rest.empty() && !rest.substr(next).starts_with(';'))) {
    throw HttpError(400, "The size of a chunk of the body is malformed.");
  }
  return size;
}

/// Sees to it that there is at least one byte in the buffer.
void BodyReader::fill() {
  if (taken_ < filled_) return;
  taken_ = 0;
  filled_ = source_.read(buffer_.data(), buffer_.size());
  if (filled_ == 0) throw HttpError(400, "The body ended early.");
}

}  // namespace lacuna
