#pragma once

#include <cstddef>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "base/json/json_text.h"
#include "jobs/spec/problems.h"

namespace lacuna {

/// Limits of a document, checked before it is parsed.
struct DocumentLimits {
  std::size_t max_bytes;
  int max_depth;
};

/// Parses one JSON document strictly: no comments, no trailing text, no NaN, valid UTF-8. Adds a
/// problem for each duplicate key (the last value is used). Throws BadJob if the document is too
/// large, too deep (checked before it is built) or malformed (with line, column and an excerpt).
Json parse_document(std::string_view text, DocumentLimits limits, std::vector<Problem>& problems);

}  // namespace lacuna
