#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace lacuna {

/// 128 bits (xxh3) of a key's text, as 32 hexadecimal digits.
std::string key_hash(std::string_view text);

/// Identifies an artefact by its inputs: everything that may change an artefact's bits is in its
/// key, and two artefacts with the same key are equal.
class ArtefactKey {
 public:
  /// `type`: lower-case letters, digits and '_', beginning with a letter. `version`: changes
  /// whenever the same inputs give other bits, or the codec changes. `settings`: canonical text of
  /// the builder's settings (settings_text()), printable ASCII without braces. Throws
  /// std::invalid_argument.
  ArtefactKey(std::string type, std::uint32_t version, std::string settings = {});

  /// Adds an input: another artefact, or a hash (lower-case hexadecimal) with a name of the form of
  /// a type, such as the scene's geometry hash. Order matters. Throws std::invalid_argument.
  ArtefactKey& from(const ArtefactKey& input) { return from(input.type(), input.hash()); }
  ArtefactKey& from(std::string_view name, std::string_view hash);

  const std::string& type() const { return type_; }
  std::uint32_t version() const { return version_; }
  /// The key as text, with the hashes of inputs: "skeleton 3 {resolution=128} domain:00ff...".
  /// Different keys have different texts.
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
