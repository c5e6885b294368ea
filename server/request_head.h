#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "server/message.h"

namespace lacuna {

inline constexpr std::size_t max_head_bytes = 16 * 1024;
inline constexpr std::size_t max_target_bytes = 1024;
inline constexpr std::size_t max_headers = 64;

/// The request line and the headers, as they were sent.
struct RequestHead {
  std::string method;
  std::string target;  ///< begins with "/"; printable ASCII
  bool is_http_1_0 = false;
  Headers headers;

  /// The client waits for "100 Continue" before it sends its body.
  bool expects_continue() const;
};

/// How a body is delimited (RFC 9112, section 6).
struct BodyFraming {
  bool chunked = false;
  std::uint64_t length = 0;  ///< in bytes, if not chunked
  bool empty() const { return !chunked && length == 0; }
};

/// The number of bytes of the head with the empty line that ends it; 0 if that has not come yet.
/// `seen`: so many bytes were searched before. Throws HttpError 414 or 431 as soon as the head is
/// too large.
std::size_t find_head_end(std::string_view received, std::size_t seen);

/// Parses a whole head, strictly: what two programs could understand in two ways is refused. Throws
/// HttpError 400, 414, 417, 431, 501 or 505.
RequestHead parse_head(std::string_view text);

/// Throws HttpError 400 where the headers leave a doubt.
BodyFraming body_framing(const RequestHead& head);

}  // namespace lacuna
