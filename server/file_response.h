#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "server/message.h"

namespace lacuna {

/// Answers a GET or HEAD with the regular file `name` in `folder`, neither reached through a
/// symbolic link. Knows validators (ETag of time, size and inode; If-None-Match, If-Range) and one
/// byte range; several ranges give the whole. Throws HttpError: 404 if it is not there, 416.
Response file_response(const Request& request, const std::filesystem::path& folder,
                       std::string_view name, std::string_view media_type);

}  // namespace lacuna
