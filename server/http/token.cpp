#include "server/http/token.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/random.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <system_error>

#include "base/storage/file_handle.h"

namespace lacuna {
namespace {

constexpr std::size_t min_characters = 16, max_characters = 256;

/// 256 random bits. Throws std::system_error.
std::string random_id() {
  std::array<unsigned char, 32> bytes;
  if (::getrandom(bytes.data(), bytes.size(), 0) != static_cast<ssize_t>(bytes.size())) {
    throw std::system_error(errno, std::generic_category(), "no random numbers");
  }
  std::string text;
  for (const unsigned char b : bytes) text += fmt::format("{:02x}", b);
  return text;
}

}  // namespace

Token Token::read(const std::filesystem::path& file) {
  const auto refuse = [&](const std::string& why) {
    throw std::runtime_error(fmt::format("token file {}: {}", file.string(), why));
  };
  const FileHandle handle(
      ::open(file.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_NOCTTY | O_CLOEXEC));
  struct stat status {};
  if (!handle || ::fstat(handle.get(), &status) != 0) refuse(std::strerror(errno));
  if (!S_ISREG(status.st_mode)) refuse("it is not a regular file");
  if (status.st_uid != ::geteuid()) refuse("it belongs to another user");
  if ((status.st_mode & 077U) != 0) {
    refuse(fmt::format("others can access it (mode {:04o}): chmod 600", status.st_mode & 07777U));
  }
  std::array<char, max_characters + 2> buffer;
  const ssize_t n = ::read(handle.get(), buffer.data(), buffer.size());
  if (n < 0) refuse(std::strerror(errno));
  std::string secret(buffer.data(), static_cast<std::size_t>(n));
  if (secret.ends_with('\n')) secret.pop_back();
  const bool printable = std::all_of(secret.begin(), secret.end(),
                                     [](char c) { return c > ' ' && c < '\x7f' && c != '%'; });
  if (!printable || secret.size() < min_characters || secret.size() > max_characters) {
    refuse(fmt::format(
        "it must hold one line of {} to {} printable ASCII characters without blanks and %",
        min_characters, max_characters));
  }
  return Token(std::move(secret));
}

bool Token::is(std::string_view shown) const {
  // The number of steps depends only on the length of `shown`.
  volatile std::size_t different = shown.size() ^ secret_.size();
  for (std::size_t i = 0; i < shown.size(); ++i) {
    different = different | static_cast<unsigned char>(shown[i] ^ secret_[i % secret_.size()]);
  }
  return different == 0;
}

std::string Sessions::open() {
  std::string id = random_id();
  const std::lock_guard lock(mutex_);
  if (ids_.size() == max_sessions) ids_.pop_front();
  ids_.emplace_back(id);
  return id;
}

bool Sessions::holds(std::string_view id) const {
  const std::lock_guard lock(mutex_);
  bool found = false;
  for (const Token& t : ids_) found = t.is(id) || found;
  return found;
}

void Sessions::close(std::string_view id) {
  const std::lock_guard lock(mutex_);
  std::erase_if(ids_, [&](const Token& t) { return t.is(id); });
}

}  // namespace lacuna
