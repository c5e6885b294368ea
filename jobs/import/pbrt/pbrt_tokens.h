#pragma once

#include <cstdint>
#include <deque>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace lacuna::pbrt {

/// A line of a scene file, for messages.
struct Place {
  std::shared_ptr<const std::string> file;
  int line = 0;

  std::string text() const;  ///< `scene.pbrt:12`
};

/// Throws SceneError: place and message.
[[noreturn]] void fail(const Place& place, const std::string& message);

struct Token {
  enum class Kind { word, text, open, close };
  Kind kind = Kind::word;
  std::string_view text;  ///< of a text, without quotes; valid as long as the Tokens
  Place place;
};

/// The tokens of a scene file and of those that it includes, in order.
class Tokens {
 public:
  static constexpr std::uint64_t max_file_bytes = std::uint64_t{1} << 29;
  static constexpr std::uint64_t max_total_bytes = std::uint64_t{1} << 31;
  static constexpr std::size_t max_depth = 32;  ///< of includes

  /// Reads the main file, also compressed by gzip if its name ends in `.gz`. Throws SceneError.
  explicit Tokens(const std::filesystem::path& file);

  /// The next token; none at the end of the main file. Throws SceneError for a text without end.
  std::optional<Token> next();
  /// The next token, not yet taken.
  const std::optional<Token>& peek();

  /// Goes on with `file` at the next token. Throws SceneError, with `place`, if it is open already,
  /// too deep or too large.
  void include(const std::filesystem::path& file, const Place& place);
  /// Number of files that are open.
  std::size_t depth() const { return files_.size(); }

 private:
  struct File {
    std::filesystem::path path;
    std::shared_ptr<const std::string> name;
    std::string_view rest;
    int line = 1;
  };

  void open(const std::filesystem::path& file);
  std::optional<Token> scan(File& file);
  std::string_view scan_text(File& file, const Place& place);

  std::vector<File> files_;
  std::deque<std::string> contents_, unescaped_;  // tokens point into them
  std::uint64_t bytes_ = 0;
  std::filesystem::path folder_;
  std::optional<Token> ahead_;
  bool peeked_ = false;
};

}  // namespace lacuna::pbrt
