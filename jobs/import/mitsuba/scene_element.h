#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace lacuna::mitsuba {

/// An element of a scene file, with `$` parameters replaced and included files in place.
struct SceneElement {
  std::string tag;
  std::vector<std::pair<std::string, std::string>> attributes;
  std::vector<SceneElement> children;
  std::string place;          ///< file and line
  mutable bool read = false;  ///< what is never read ends in a note

  /// Empty if it is absent.
  const std::string& attribute(std::string_view name) const;
  bool has(std::string_view name) const;
  const std::string& type() const { return attribute("type"); }
  /// A spectrum whose file does not exist: the parameter is as if it were not there.
  bool lacks_file() const { return tag == "spectrum" && has("filename") && !has("value"); }
  /// The `name` without case and underscores: Mitsuba 2 and 3 write to_world for toWorld.
  std::string name() const;
  /// `bsdf "wall" (diffuse)`, as in messages.
  std::string label() const;
  /// Throws SceneError with place and label.
  [[noreturn]] void fail(const std::string& what) const;
};

/// A name without case and underscores.
std::string plain_name(std::string_view name);

/// Limits of what is read of one scene, with all that it includes.
inline constexpr std::size_t max_xml_bytes = std::size_t{256} << 20;
inline constexpr std::size_t max_elements = std::size_t{1} << 22;
inline constexpr int max_element_depth = 64, max_include_depth = 16;

/// Reads a scene (its root element `scene`). Files that it names lie in the folder of `file`.
/// Throws SceneError with file and line: no XML, a document type, an unknown `$` parameter,
/// includes in a circle, and what exceeds the limits.
SceneElement read_scene_file(const std::filesystem::path& file);
/// The same of a text, for which nothing can be included.
SceneElement read_scene_text(std::string_view xml, const std::string& label);

/// The file that `name` says, relative to `folder`; none if it would lie outside, also through a
/// link. It need not exist.
std::optional<std::filesystem::path> find_within(const std::filesystem::path& folder,
                                                 const std::string& name);
/// The same; throws SceneError with `at` if it would lie outside.
std::filesystem::path file_within(const std::filesystem::path& folder, const std::string& name,
                                  const SceneElement& at);

}  // namespace lacuna::mitsuba
