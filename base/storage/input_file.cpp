#include "base/storage/input_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>
#include <xxhash.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <memory>
#include <span>
#include <stdexcept>

#include "base/storage/file_handle.h"
#include "base/storage/passing_error.h"

namespace lacuna {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(int error, const char* what, const fs::path& file) {
  throw_if_it_may_pass(error, file, fs::absolute(file).parent_path());
  throw std::invalid_argument(fmt::format("cannot be {}: {}", what, std::strerror(error)));
}

std::string hash_text(XXH64_hash_t hash) { return fmt::format("{:016x}", hash); }

/// A regular file that is open, and its size.
class OpenInput {
 public:
  explicit OpenInput(const fs::path& file)
      : file_(file),  // O_NONBLOCK: opening a FIFO must not wait for its writer
        handle_(::open(file.c_str(), O_RDONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC)) {
    struct stat info {};
    if (!handle_ || ::fstat(handle_.get(), &info) != 0) fail(errno, "opened", file);
    if (!S_ISREG(info.st_mode)) throw std::invalid_argument("is not a regular file");
    size_ = static_cast<std::uint64_t>(info.st_size);
  }

  std::uint64_t size() const { return size_; }

  /// The next `part.size()` bytes.
  void read(std::span<std::uint8_t> part) {
    while (!part.empty()) {
      const ssize_t got = ::read(handle_.get(), part.data(), part.size());
      if (got < 0 && errno == EINTR) continue;
      if (got < 0) fail(errno, "read", file_);
      if (got == 0) {  // it is being written
        throw InputUnreadable(EAGAIN,
                              fmt::format("{} was cut short while it was read", file_.string()));
      }
      part = part.subspan(static_cast<std::size_t>(got));
    }
  }

 private:
  const fs::path& file_;
  FileHandle handle_;
  std::uint64_t size_ = 0;
};

}  // namespace

void throw_if_it_may_pass(int error, const fs::path& file, const fs::path& folder) {
  if (may_pass(error)) throw InputUnreadable(error, fmt::format("cannot read {}", file.string()));
  if (error != ENOENT) return;
  std::error_code unknown;  // an unreadable folder counts as empty
  if (fs::exists(folder, unknown) && !fs::is_empty(folder, unknown) && !unknown) return;
  throw InputUnreadable(
      error, fmt::format("cannot read {}: {} is missing or empty", file.string(), folder.string()));
}

InputBytes read_input(const fs::path& file, std::uint64_t max_bytes, InputFile& about) {
  OpenInput input(file);
  if (input.size() > max_bytes) {
    throw std::length_error(fmt::format("has {} bytes", input.size()));
  }
  InputBytes bytes(input.size());
  input.read(bytes);
  about.bytes = input.size();
  about.hash = hash_text(XXH3_64bits(bytes.data(), bytes.size()));
  return bytes;
}

InputFile measure_input(const fs::path& file, std::optional<std::uint64_t> expected) {
  OpenInput input(file);
  InputFile measured;
  measured.bytes = input.size();
  if (expected && input.size() != *expected) return measured;
  const std::unique_ptr<XXH3_state_t, decltype(&XXH3_freeState)> state(XXH3_createState(),
                                                                       &XXH3_freeState);
  XXH3_64bits_reset(state.get());
  InputBytes buffer(std::size_t{1} << 20);
  for (std::uint64_t left = input.size(); left > 0;) {
    const std::span part(buffer.data(), std::min<std::uint64_t>(left, buffer.size()));
    input.read(part);
    XXH3_64bits_update(state.get(), part.data(), part.size());
    left -= part.size();
  }
  measured.hash = hash_text(XXH3_64bits_digest(state.get()));
  return measured;
}

}  // namespace lacuna
