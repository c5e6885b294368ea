#pragma once

#include <sys/stat.h>

#include <filesystem>
#include <string>
#include <string_view>

#include "analysis/storage/file_handle.h"
#include "server/http/message.h"

namespace lacuna {

/// The regular file `name` in `folder`, neither reached through a symbolic link, and its status; an
/// empty handle if there is none.
FileHandle open_regular(const std::filesystem::path& folder, std::string_view name,
                        struct stat& status);

/// Whether an If-None-Match header's list of entity tags holds `tag`.
bool holds_tag(std::string_view list, std::string_view tag);

/// Answers a GET or HEAD with the regular file `name` in `folder`, neither reached through a
/// symbolic link. Knows validators (ETag of time, size and inode; If-None-Match, If-Range) and one
/// byte range; several ranges give the whole. Throws HttpError: 404 if it is not there, 416.
Response file_response(const Request& request, const std::filesystem::path& folder,
                       std::string_view name, std::string_view media_type);

}  // namespace lacuna
