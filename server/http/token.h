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
  /// Reads it from a file: one line of 16 to 256 printable ASCII characters without blanks and %
  /// (which the HTTP library decodes as an escape in headers). Throws std::runtime_error, naming
  /// the file, otherwise, and if it is not a regular file of this user that nobody else can read or
  /// write (mode 0600).
  static Token read(const std::filesystem::path& file);

  /// Constant time with respect to the secret, including its length.
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

  /// Opens a session and returns its id. Throws std::system_error.
  std::string open();
  bool holds(std::string_view id) const;
  /// Does nothing if there is no such session.
  void close(std::string_view id);

 private:
  mutable std::mutex mutex_;
  std::deque<Token> ids_;
};

}  // namespace lacuna
