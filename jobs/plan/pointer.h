#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "analysis/json/json_text.h"

namespace lacuna {

/// The reference tokens of a JSON pointer (RFC 6901), unescaped.
std::vector<std::string> pointer_tokens(std::string_view pointer);

/// What is wrong with a pointer to a setting, if anything: it must begin with '/', and '~' stand
/// only in "~0" and "~1".
std::optional<std::string> pointer_problem(std::string_view pointer);

/// Puts a value at a place of a document. A key of the document itself that lacks is taken from
/// `defaults`, objects further on are made; a method's name alone becomes an object with its
/// "type". Tells why it cannot, if it cannot.
std::optional<std::string> set_at(Json& document, const Json& defaults, std::string_view pointer,
                                  Json value);

}  // namespace lacuna
