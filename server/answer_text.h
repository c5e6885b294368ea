#pragma once

#include <string>
#include <string_view>

#include "server/request_head.h"

namespace lacuna {

/// The status line and the headers of an answer, with the empty line behind them. A stream goes out
/// in chunks, or to a client of HTTP/1.0 as it is; everything else has a length. Every answer ends
/// its connection, and forbids sniffing, framing, referrers and foreign scripts. Throws
/// std::logic_error for a header with a control character.
std::string answer_head(const Response& response, bool to_http_1_0);

/// A text of a stream in the form in which it is sent; the empty one ends the stream.
std::string stream_text(std::string_view text, bool to_http_1_0);

}  // namespace lacuna
