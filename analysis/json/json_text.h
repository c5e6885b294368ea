#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

namespace lacuna {

using Json = nlohmann::json;                 // keys in alphabetical order: documents that are read
using OrderedJson = nlohmann::ordered_json;  // keys as they were put: documents that are written

// Text from JSON and back, compiled in one place: writer and parser cost seconds in each source.

enum class Escape { as_needed, all_but_ascii };

/// One line of text. Bytes that are no UTF-8 (an error message may quote any) become U+FFFD; a
/// number that is not finite becomes null.
std::string json_text(const Json& json, Escape escape = Escape::as_needed);
std::string json_text(const OrderedJson& json, Escape escape = Escape::as_needed);

/// Text of a document for files: two spaces of indent, a newline at its end; else the same.
std::string document_text(const OrderedJson& json);

/// JSON that the project itself has written. Throws std::logic_error for anything else; what comes
/// from outside is read by parse_document().
OrderedJson parse_own(std::string_view text);

}  // namespace lacuna
