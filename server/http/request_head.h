#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace lacuna {

inline constexpr std::size_t max_head_bytes = 16 * 1024;
inline constexpr std::size_t max_target_bytes = 1024;
inline constexpr std::size_t max_headers = 64;

/// The parts of a request that the waiting room needs before the HTTP library parses it.
struct RequestHead {
  /// The head in a form that the library can read in one way only: as it was sent, but for three
  /// things. A % in a header is written %25, since the library decodes escapes there. Expect and
  /// Accept-Encoding are left out: the body is invited when it is read, and answers are never
  /// compressed, so that an ETag stands for bytes. A Range that is not "bytes=A-B", "bytes=A-" or
  /// "bytes=-N" is left out, which RFC 9110, section 14.2, allows.
  std::string text;
  bool expects_continue = false;  ///< the client waits for "100 Continue" before it sends its body
  bool chunked = false;           ///< how the body is delimited (RFC 9112, section 6)
  std::uint64_t length = 0;       ///< of the body in bytes, if not chunked

  bool has_body() const { return chunked || length > 0; }
};

/// The number of bytes of the head with the empty line that ends it; 0 if that has not come yet.
/// `seen`: so many bytes were searched before. Throws HttpError 414 or 431 as soon as the head is
/// too large.
std::size_t find_head_end(std::string_view received, std::size_t seen);

/// Checks a whole head, strictly: what two programs could understand in two ways is refused. Throws
/// HttpError 400, 414, 417, 431, 501 or 505.
RequestHead check_head(std::string_view text);

}  // namespace lacuna
