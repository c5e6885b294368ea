#include "server/http/file_response.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>

#include <algorithm>
#include <cerrno>

#include "analysis/storage/passing_error.h"

namespace lacuna {
namespace {

/// The range within a file of `size` bytes: the library takes any for one within the file.
ByteRange within(const ByteRange& asked, std::int64_t size) {
  const bool counts_back = asked.first < 0;
  const std::int64_t first =
      counts_back ? std::max<std::int64_t>(0, size - asked.last) : asked.first;
  const bool to_end = counts_back || asked.last < 0;
  const std::int64_t last = to_end ? size - 1 : std::min(asked.last, size - 1);
  if (first > last) {
    throw HttpError(416, fmt::format("The range is outside the file's {} bytes.", size))
        .with("Content-Range", fmt::format("bytes */{}", size));
  }
  return {first, last};
}

}  // namespace

bool holds_tag(std::string_view list, std::string_view tag) {
  return list == "*" || list.find(tag) != std::string_view::npos;
}

FileHandle open_regular(const std::filesystem::path& folder, std::string_view name,
                        struct stat& status) {
  const FileHandle dir(::open(folder.c_str(), O_PATH | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC));
  // Not blocking, so that a FIFO in a file's place holds no thread.
  FileHandle file(dir ? ::openat(dir.get(), std::string(name).c_str(),
                                 O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC)
                      : -1);
  if (!file && is_want_of_descriptors(errno)) throw_file_error(errno, "read", folder / name);
  if (!file || ::fstat(file.get(), &status) != 0 || !S_ISREG(status.st_mode)) return {};
  return file;
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
  const auto none_match = request.header("if-none-match");
  if (none_match && holds_tag(*none_match, tag)) {
    response.status = 304;
    return response;
  }
  response.content_type = media_type;
  const auto if_range = request.header("if-range");
  if (request.range && (!if_range || *if_range == tag)) {
    response.range = within(*request.range, status.st_size);
  }
  response.file = FilePart{std::move(file), 0, status.st_size};
  return response;
}

}  // namespace lacuna
