#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>

#include "server/request_head.h"

namespace lacuna {

/// Where the bytes of a body come from.
class ByteSource {
 public:
  enum class Pace { total, rate };  ///< a deadline for the whole, or a least rate

  ByteSource() = default;
  ByteSource(const ByteSource&) = delete;
  ByteSource& operator=(const ByteSource&) = delete;
  virtual ~ByteSource() = default;
  virtual void begin_body(Pace) {}
  virtual void end_body() {}
  /// As read(2): 0 at the end. Throws HttpError 408 or 503.
  virtual std::size_t read(char* data, std::size_t size) = 0;
};

/// Bytes that have come already.
class TextSource : public ByteSource {
 public:
  explicit TextSource(std::string_view text) : text_(text) {}
  std::size_t read(char* data, std::size_t size) override;

 private:
  std::string_view text_;
};

/// Reads one body off its source, counted and capped.
class BodyReader {
 public:
  /// Both outlive it.
  BodyReader(const RequestHead& head, BodyFraming framing, ByteSource& source)
      : head_(head), framing_(framing), source_(source), complete_(framing.empty()) {}

  /// See Request::read_body and Request::read_body_to.
  std::string text(std::size_t max_bytes);
  std::uint64_t to_file(int fd, std::uint64_t max_bytes);
  /// Nothing of it is left on the wire.
  bool complete() const { return complete_; }

 private:
  template <class Sink>
  void read(ByteSource::Pace pace, std::uint64_t max_bytes, const Sink& sink);
  template <class Sink>
  void read_chunks(std::uint64_t max_bytes, const Sink& sink);
  template <class Sink>
  void pass_on(std::uint64_t bytes, const Sink& sink);
  std::string line();
  std::uint64_t chunk_size();
  void fill();

  const RequestHead& head_;
  const BodyFraming framing_;
  ByteSource& source_;
  bool complete_;
  std::uint64_t lines_left_ = 0;  ///< bytes that the lines between the chunks may still take
  std::array<char, 16 * 1024> buffer_;
  std::size_t taken_ = 0, filled_ = 0;
};

}  // namespace lacuna
