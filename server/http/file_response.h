#pragma once

#include <cstdint>
#include <filesystem>
#include <string_view>

#include "server/http/message.h"

namespace lacuna {

/// Whether the client has the entity with this tag (If-None-Match).
bool client_has(const Request& request, std::string_view tag);

/// Answers a GET or HEAD with the regular file `name` in `folder`, neither of which may be a
/// symbolic link. Supports validators (ETag of time, size and inode; If-None-Match, If-Range) and
/// one byte range; several ranges return the whole file. Throws HttpError 404 if it is missing,
/// 416.
Response file_response(const Request& request, const std::filesystem::path& folder,
                       std::string_view name, std::string_view media_type);

/// The text file `name` in `folder` from byte `offset` to its end, at most 1 MiB, with the header
/// Next-Offset for the next call. A missing file counts as empty. Throws HttpError 416 if `offset`
/// is beyond the end.
Response log_response(const std::filesystem::path& folder, std::string_view name,
                      std::int64_t offset);

}  // namespace lacuna
