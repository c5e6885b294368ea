#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/json/json_text.h"

namespace lacuna {

/// The reference tokens of a JSON pointer (RFC 6901), unescaped.
std::vector<std::string> pointer_tokens(std::string_view pointer);

/// The error in a pointer to a setting, if any: it must begin with '/', and '~' may occur only in
/// "~0" and "~1".
std::optional<std::string> pointer_problem(std::string_view pointer);

/// Sets the value at a pointer into a document. A missing top-level key is copied from `defaults`;
/// missing objects below it are created; a method's name alone becomes an object with its "type".
/// Returns the error, if any.
std::optional<std::string> set_at(Json& document, const Json& defaults, std::string_view pointer,
                                  Json value);

}  // namespace lacuna
