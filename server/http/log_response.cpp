#include "server/http/log_response.h"

#include <fmt/format.h>
#include <sys/stat.h>

#include <algorithm>
#include <utility>

#include "server/http/file_response.h"

namespace lacuna {

Response log_response(const std::filesystem::path& folder, std::string_view name,
                      std::int64_t offset) {
  constexpr std::int64_t most = 1 << 20;
  struct stat status {};
  FileHandle file = open_regular(folder, name, status);
  const std::int64_t size = file ? status.st_size : 0;
  if (offset > size) {
    throw HttpError(416, fmt::format("The log has {} bytes so far.", size));
  }
  Response response;
  response.content_type = "text/plain; charset=utf-8";
  const std::int64_t length = std::min(size - offset, most);
  response.headers = {{"Cache-Control", "no-store"},
                      {"Next-Offset", fmt::format("{}", offset + length)}};
  if (length > 0) response.file = FilePart{std::move(file), offset, length};
  return response;
}

}  // namespace lacuna
