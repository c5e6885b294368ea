#pragma once

#include <filesystem>
#include <functional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/json/json_text.h"

namespace lacuna::gltf {

class GltfObject;

/// What becomes of a part of a file.
enum class Treatment {
  exact,         ///< as the specification says
  approximated,  ///< something close to it
  left_out,      ///< ignored with a warning; refused where the file requires it
};

/// A part of glTF 2.0, or an extension of it.
struct Feature {
  std::string_view name;  ///< of an extension: as in extensionsUsed
  Treatment treatment;
  std::string_view how;     ///< what is done, or what is not; a sentence without its full stop
  std::string_view remedy;  ///< how to make a file that is read; may be empty
  /// Whether the file has this part; null for extensions, which files name.
  bool (*used_in)(const GltfObject& root) = nullptr;
};

/// All that is known: the table of docs/scenes.md and of `lacuna check`. What is not in it is left
/// out.
std::span<const Feature> all_features();
/// The extensions that a file lists as used, and those that it has anywhere but in extras.
std::set<std::string, std::less<>> extensions_of(const Json& file);
/// "; " and the remedy for an extension; empty: none is known.
std::string remedy_for(std::string_view extension);
/// The extensions that may stand in extensionsRequired, separated by commas.
std::string supported_extensions();

}  // namespace lacuna::gltf

namespace lacuna {

/// A row of what a file uses.
struct FeatureUse {
  std::string name, treatment, how;
};
/// What of glTF a file uses, and how each part is treated. Reads only the main file. Throws
/// SceneError.
std::vector<FeatureUse> features_of(const std::filesystem::path& file);
/// The same of all features, as a table in Markdown.
std::string feature_table();

}  // namespace lacuna
