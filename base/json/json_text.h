#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

namespace lacuna {

using Json = nlohmann::json;  // keys in alphabetical order: documents that are read
using OrderedJson =
    nlohmann::ordered_json;  // keys in order of insertion: documents that are written

// Converts JSON to text and back. One source file instantiates the library's writer and parser,
// which take seconds to compile.

enum class Escape { as_needed, all_but_ascii };

/// JSON as one line of text. Invalid UTF-8 (an error message may quote any bytes) becomes U+FFFD; a
/// number that is not finite becomes null.
std::string json_text(const Json& json, Escape escape = Escape::as_needed);
std::string json_text(const OrderedJson& json, Escape escape = Escape::as_needed);

/// JSON as text for files: json_text() with an indent of two spaces and a final newline.
std::string document_text(const OrderedJson& json);

/// Parses JSON that the project itself has written. Throws std::logic_error for anything else;
/// input from outside is parsed by parse_document().
OrderedJson parse_own(std::string_view text);
/// parse_own() with keys in alphabetical order.
Json parse_own_sorted(std::string_view text);

/// Whether `text` is well-formed UTF-8.
bool is_utf8(std::string_view text);

}  // namespace lacuna
