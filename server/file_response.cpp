#include "server/file_response.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>

#include <algorithm>
#include <charconv>

namespace lacuna {
namespace {

std::optional<std::int64_t> number(std::string_view digits) {
  std::int64_t value = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (error != std::errc() || end != digits.data() + digits.size() || value < 0)
    return std::nullopt;
  return value;
}

/// The part that a Range header means (RFC 9110, section 14): nothing if it means the whole.
std::optional<std::pair<std::int64_t, std::int64_t>> one_range(std::string_view value,
                                                               std::int64_t size) {
  constexpr std::string_view unit = "bytes=";
  const std::size_t dash = value.find('-');
  if (!value.starts_with(unit) || value.find(',') != std::string_view::npos ||
      dash == std::string_view::npos) {
    return std::nullopt;
  }
  const std::string_view from = value.substr(unit.size(), dash - unit.size());
  const std::string_view to = value.substr(dash + 1);
  const auto first = number(from), last = number(to);
  if ((!from.empty() && !first) || (!to.empty() && !last) || (!first && !last)) return std::nullopt;
  if (first && last && *last < *first) return std::nullopt;
  const std::int64_t begin = first ? *first : std::max<std::int64_t>(0, size - *last);
  const std::int64_t end = first && last && *last < size ? *last + 1 : size;
  if (begin >= end) {
    throw HttpError(416, fmt::format("The range is outside the file's {} bytes.", size))
        .with("Content-Range", fmt::format("bytes */{}", size));
  }
  return std::pair(begin, end - begin);
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
  FilePart part{std::move(file), 0, status.st_size};
  const auto range = request.header("range");
  const auto if_range = request.header("if-range");
  if (range && (!if_range || *if_range == tag)) {
    if (const auto found = one_range(*range, status.st_size)) {
      std::tie(part.offset, part.length) = *found;
      response.status = 206;
      response.headers.emplace_back(
          "Content-Range", fmt::format("bytes {}-{}/{}", part.offset, part.offset + part.length - 1,
                                       status.st_size));
    }
  }
  response.file = std::move(part);
  return response;
}

}  // namespace lacuna
