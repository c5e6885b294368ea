#pragma once

#include <deque>
#include <filesystem>
#include <mutex>
#include <string>
#include <string_view>

namespace lacuna {

/// The secret token of clients. Never printed.
class Token {
 public:
  explicit Token(std::string secret) : secret_(std::move(secret)) {}
  /// Reads it off a file: one line of 16 to 256 printable ASCII characters, no blank and no %
  /// (which the HTTP library takes for an escape in the header that shows it). Throws
  /// std::runtime_error, naming the file, if that is not so, or if the file is not a regular file
  /// of this user that nobody else can read or write (mode 0600).
  static Token read(const std::filesystem::path& file);

  /// Takes a time that tells nothing about the secret, not even its length.
  bool is(std::string_view shown) const;

 private:
  std::string secret_;  ///< not empty
};

inline constexpr std::string_view session_cookie = "lacuna_session";

/// Sessions of browsers that have sent the token once, each with a random id of 256 bits, in 64
/// hexadecimal digits. In memory only, with a limit: the oldest is dropped. Thread-safe.
class Sessions {
 public:
  static constexpr std::size_t max_sessions = 64;

  /// A new session's id. Throws std::system_error.
  std::string open();
  bool holds(std::string_view id) const;
  /// Nothing happens if it is not there.
  void close(std::string_view id);

 private:
  mutable std::mutex mutex_;
  std::deque<Token> ids_;
};

}  // namespace lacuna
