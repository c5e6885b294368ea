#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace lacuna {

/// The secret token of clients. Never printed.
class Token {
 public:
  explicit Token(std::string secret) : secret_(std::move(secret)) {}
  /// Reads it off a file: one line of 16 to 256 printable ASCII characters without blanks. Throws
  /// std::runtime_error, naming the file, if that is not so, or if the file is not a regular file
  /// of this user that nobody else can read or write (mode 0600).
  static Token read(const std::filesystem::path& file);

  /// Takes a time that tells nothing about the secret, not even its length.
  bool is(std::string_view shown) const;

 private:
  std::string secret_;  ///< not empty
};

/// 256 random bits as 64 hexadecimal digits. Throws std::system_error.
std::string random_secret();

}  // namespace lacuna
