#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

namespace lacuna {

/// Holds the framing of a chunked body (RFC 9112, section 7.1) to its letter before the HTTP
/// library decodes it: the library takes signs, blanks and "0x" in front of a size, and knows no
/// trailers.
class ChunkCheck {
 public:
  /// Checks the next bytes, in place. Returns how many of them the library gets: all but trailers,
  /// which are checked and dropped. Throws HttpError 400.
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
