#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace lacuna {

/// 128 bits (xxh3) of a key's text, as 32 hexadecimal digits.
std::string key_hash(std::string_view text);

/// What an artefact is made of. Two artefacts with the same key are the same; whatever may change
/// an artefact's bits is in its key.
class ArtefactKey {
 public:
  /// `type`: lower-case letters, digits and '_', beginning with a letter. `version`: another one
  /// whenever the same inputs give other bits, or the codec changes. `settings`: canonical text of
  /// all that the builder is told (settings_text()), printable ASCII without braces. Throws
  /// std::invalid_argument.
  ArtefactKey(std::string type, std::uint32_t version, std::string settings = {});

  /// Adds what it is made from: another artefact, or a hash (lower-case hexadecimal) with a name as
  /// of a type, as the scene's geometry hash. Their order counts. Throws std::invalid_argument.
  ArtefactKey& from(const ArtefactKey& input) { return from(input.type(), input.hash()); }
  ArtefactKey& from(std::string_view name, std::string_view hash);

  const std::string& type() const { return type_; }
  std::uint32_t version() const { return version_; }
  /// The whole key, of inputs their hashes: "skeleton 3 {resolution=128} domain:00ff...". No two
  /// keys have the same text.
  std::string text() const;
  /// key_hash() of text().
  std::string hash() const;

 private:
  std::string type_;
  std::uint32_t version_;
  std::string settings_;
  std::string inputs_;
};

}  // namespace lacuna
