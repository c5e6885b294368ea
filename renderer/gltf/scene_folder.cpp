#include "renderer/gltf/scene_folder.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstring>

#include "renderer/geometry/scene_data.h"

namespace lacuna {
namespace {

constexpr std::uintmax_t byte_limit = (std::uintmax_t{1} << 31) - 1;  // tinygltf counts in int

constexpr std::size_t max_uri = 4096;  // PATH_MAX of Linux

class Descriptor {
 public:
  explicit Descriptor(int fd) : fd_(fd) {}
  ~Descriptor() {
    if (fd_ >= 0) ::close(fd_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  int get() const { return fd_; }

 private:
  int fd_;
};

[[noreturn]] void refuse_escape(const std::string& uri, const std::string& place) {
  throw SceneError(place + " has a broken escape in \"" + uri +
                   "\"; allowed: % and two hexadecimal digits, not 00");
}

}  // namespace

std::string percent_decode(const std::string& uri, const std::string& place) {
  std::string out;
  out.reserve(uri.size());
  for (std::size_t i = 0; i < uri.size(); ++i) {
    if (uri[i] != '%') {
      out.push_back(uri[i]);
      continue;
    }
    unsigned value = 0;
    const char* first = uri.data() + i + 1;
    const bool complete = i + 2 < uri.size();
    if (!complete || std::from_chars(first, first + 2, value, 16).ptr != first + 2 || value == 0) {
      refuse_escape(uri, place);
    }
    out.push_back(static_cast<char>(value));
    i += 2;
  }
  return out;
}

SceneFolder::SceneFolder(const std::filesystem::path& main_file)
    : main_file_(main_file), bytes_left_(byte_limit) {
  std::error_code error;
  const auto parent = main_file.has_parent_path() ? main_file.parent_path() : ".";
  root_ = std::filesystem::canonical(parent, error);
  if (error) throw SceneError("its folder cannot be opened: " + error.message());
}

Bytes SceneFolder::read_main() { return read_regular(main_file_, "the scene file"); }

Bytes SceneFolder::read(const std::string& uri, const std::string& place) {
  if (uri.size() > max_uri) {
    throw SceneError(place + " is a path of " + std::to_string(uri.size()) +
                     " bytes; allowed: " + std::to_string(max_uri));
  }
  const std::string name = percent_decode(uri, place);
  const std::filesystem::path relative(name);
  const bool climbs = std::find(relative.begin(), relative.end(), "..") != relative.end();
  if (name.empty() || name.find('\0') != std::string::npos || relative.is_absolute() || climbs ||
      name.find(':') != std::string::npos) {
    throw SceneError(place + " is \"" + uri +
                     "\"; allowed: a relative path inside the scene's folder");
  }
  std::error_code error;
  const auto file = std::filesystem::canonical(root_ / relative, error);
  if (error) throw SceneError(place + ": \"" + uri + "\" cannot be opened: " + error.message());
  const auto [root_end, rest] = std::mismatch(root_.begin(), root_.end(), file.begin(), file.end());
  if (root_end != root_.end()) {
    throw SceneError(place + ": \"" + uri + "\" leaves the scene's folder by a symbolic link");
  }
  return read_regular(file, place + ": \"" + uri + "\"");
}

Bytes SceneFolder::read_regular(const std::filesystem::path& file, const std::string& place) {
  const auto fail = [&place](const std::string& what) { throw SceneError(place + " " + what); };
  // O_NONBLOCK: opening a FIFO must not wait for its writer.
  const Descriptor fd(::open(file.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC));
  struct stat status {};
  if (fd.get() < 0 || ::fstat(fd.get(), &status) != 0) {
    fail(std::string("cannot be opened: ") + std::strerror(errno));
  }
  if (!S_ISREG(status.st_mode)) fail("is not a regular file");
  const auto size = static_cast<std::uintmax_t>(status.st_size);
  if (size > bytes_left_) {
    fail("has " + std::to_string(size) + " bytes; allowed: " + std::to_string(byte_limit) +
         " for all files of a scene");
  }
  Bytes bytes(size);
  std::size_t done = 0;
  while (done < bytes.size()) {
    const ssize_t got = ::read(fd.get(), bytes.data() + done, bytes.size() - done);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) fail(std::string("cannot be read: ") + std::strerror(errno));
    if (got == 0) fail("was truncated while it was read");
    done += static_cast<std::size_t>(got);
  }
  bytes_left_ -= size;
  return bytes;
}

}  // namespace lacuna
