#pragma once

#include <cstdint>
#include <filesystem>
#include <string_view>

#include "server/http/message.h"

namespace lacuna {

/// The text file `name` in `folder` from byte `offset` to its end, at most 1 MiB, with the header
/// Next-Offset for the next call. A file that is not there yet is empty. Throws HttpError 416 if
/// `offset` is beyond the end.
Response log_response(const std::filesystem::path& folder, std::string_view name,
                      std::int64_t offset);

}  // namespace lacuna
