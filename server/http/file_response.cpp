#include "server/http/file_response.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>

#include <algorithm>
#include <cerrno>
#include <utility>

#include "base/storage/passing_error.h"

namespace lacuna {
namespace {

/// Opens the regular file `name` in `folder`, neither of which may be a symbolic link, with its
/// status; an empty handle if there is none.
FileHandle open_regular(const std::filesystem::path& folder, std::string_view name,
                        struct stat& status) {
  const FileHandle dir(::open(folder.c_str(), O_PATH | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC));
  // Non-blocking, so that a FIFO does not block a thread.
  FileHandle file(dir ? ::openat(dir.get(), std::string(name).c_str(),
                                 O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC)
                      : -1);
  if (!file && is_want_of_descriptors(errno)) throw_file_error(errno, "read", folder / name);
  if (!file || ::fstat(file.get(), &status) != 0 || !S_ISREG(status.st_mode)) return {};
  return file;
}

/// Narrows the response, of a whole file, to a range.
void narrow(Response& response, const ByteRange& range) {
  const std::int64_t size = response.file->length;
  const bool counts_back = range.first < 0;
  const std::int64_t first =
      counts_back ? std::max<std::int64_t>(0, size - range.last) : range.first;
  const bool to_end = counts_back || range.last < 0;
  const std::int64_t last = to_end ? size - 1 : std::min(range.last, size - 1);
  if (first > last) {
    throw HttpError(416, fmt::format("The range is outside the file's {} bytes.", size))
        .with("Content-Range", fmt::format("bytes */{}", size));
  }
  response.status = 206;
  response.headers.emplace_back("Content-Range", fmt::format("bytes {}-{}/{}", first, last, size));
  response.file->offset = first;
  response.file->length = last - first + 1;
}

}  // namespace

bool client_has(const Request& request, std::string_view tag) {
  const auto list = request.header("if-none-match");
  return list && (*list == "*" || list->find(tag) != std::string::npos);
}

Response file_response(const Request& request, const std::filesystem::path& folder,
                       std::string_view name, std::string_view media_type) {
  struct stat status {};
  FileHandle file = open_regular(folder, name, status);
  if (!file) throw HttpError(404, fmt::format("There is no file \"{}\".", name));
  const std::string tag = fmt::format("\"{:x}.{:x}-{:x}-{:x}\"", status.st_mtim.tv_sec,
                                      status.st_mtim.tv_nsec, status.st_size, status.st_ino);
  Response response;
  response.headers = {{"ETag", tag}, {"Cache-Control", "no-cache"}, {"Accept-Ranges", "bytes"}};
  if (client_has(request, tag)) {
    response.status = 304;
    return response;
  }
  response.content_type = media_type;
  response.file = FilePart{std::move(file), 0, status.st_size};
  const auto if_range = request.header("if-range");
  if (request.range && (!if_range || *if_range == tag)) narrow(response, *request.range);
  return response;
}

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
