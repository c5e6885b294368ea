#pragma once

#include <cstddef>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "analysis/json/json_text.h"
#include "jobs/spec/problems.h"

namespace lacuna {

/// What a document may be before anything in it is looked at.
struct DocumentLimits {
  std::size_t max_bytes;
  int max_depth;
};

/// Parses one JSON document strictly: no comments, nothing behind it, no NaN, valid UTF-8. Adds a
/// problem for each duplicate key (of which the last value counts). Throws BadJob if there is no
/// document to go on with: too large, too deep (nothing deep is ever built), malformed (with line,
/// column and an excerpt).
Json parse_document(std::string_view text, DocumentLimits limits, std::vector<Problem>& problems);

}  // namespace lacuna
