#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

namespace lacuna {

/// Validates the framing of a chunked body strictly (RFC 9112, section 7.1) before the HTTP library
/// decodes it: the library accepts signs, blanks and "0x" before a size, and does not know
/// trailers.
class ChunkCheck {
 public:
  /// Validates the next bytes, in place. Returns the number of bytes for the library: all except
  /// trailers, which are validated and dropped. Throws HttpError 400.
  std::size_t pass(char* data, std::size_t size);
  /// The end of the body has passed.
  bool complete() const { return state_ == State::complete; }

 private:
  enum class State { size, data, data_end, trailer, complete };
  bool passes(char c);
  void end_line();
  void begin_chunk();

  State state_ = State::size;
  std::string line_;        ///< so far, without its end
  std::uint64_t left_ = 0;  ///< bytes of the chunk's data
  int trailers_ = 0;
};

}  // namespace lacuna
