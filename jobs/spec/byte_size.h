#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace lacuna {

/// Bytes from "4G", "512M", "65536K" or "1073741824": an integer; K, M, G and T are powers of 1024.
/// Throws std::invalid_argument that quotes the text and says what is allowed.
std::uint64_t parse_byte_size(std::string_view text);

/// "4.0 GiB", "1.5 MiB", "12 bytes".
std::string byte_size_text(std::uint64_t bytes);

}  // namespace lacuna
