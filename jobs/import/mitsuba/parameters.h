#pragma once

#include <functional>
#include <map>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "jobs/import/imported_scene.h"
#include "jobs/import/mitsuba/scene_element.h"

namespace lacuna::mitsuba {

/// Radians.
inline constexpr double degree = std::numbers::pi / 180;

/// The elements that others refer to by `id`.
class SceneIds {
 public:
  /// Enters `root` and all below; both outlive this. An `alias` gives an element a second id.
  explicit SceneIds(const SceneElement& root);
  /// The element itself, or that which a `ref` names. Throws SceneError if there is none.
  const SceneElement& resolve(const SceneElement& element) const;

 private:
  void enter(const SceneElement& element);
  std::map<std::string, const SceneElement*> elements_;
};

/// The children of an element as the parameters of a plugin. A value of the wrong kind is an error;
/// what is not read is noted by note_unread(). Names are given plain ("toworld").
class Parameters {
 public:
  Parameters(const SceneElement& element, const SceneIds& ids) : element_(element), ids_(ids) {
    element.read = true;
  }

  const SceneElement& element() const { return element_; }
  bool has(std::string_view name) const { return peek(name) != nullptr; }
  double number(std::string_view name, double fallback) const;
  int integer(std::string_view name, int fallback) const;
  bool boolean(std::string_view name, bool fallback) const;
  std::string text(std::string_view name, const std::string& fallback) const;
  std::optional<V3d> vector(std::string_view name) const;
  /// A colour: rgb, srgb, spectrum, blackbody, or a number as grey.
  std::optional<Rgb> color(std::string_view name) const;
  /// `to_world` or another; the identity if it is absent, the first of an animation.
  M44d transform(std::string_view name) const;
  /// An object of this name (texture, bsdf, ...), or null.
  const SceneElement* object(std::string_view name) const;
  /// All objects with this tag (through `ref`), in order, whatever their names.
  std::vector<const SceneElement*> objects(std::string_view tag) const;
  /// The same with the names by which this element has them.
  std::vector<std::pair<std::string, const SceneElement*>> named_objects(
      std::string_view tag) const;
  /// Marks a parameter as known without an effect on the picture.
  void ignore(std::initializer_list<std::string_view> names) const;
  void note_unread(std::vector<ImportNote>& notes) const;
  /// Marks all as read.
  void ignore_all() const;

 private:
  const SceneElement* peek(std::string_view name) const;
  const SceneElement* find(std::string_view name) const;
  const SceneElement* value(std::string_view name, std::string_view tag) const;

  const SceneElement& element_;
  const SceneIds& ids_;
};

/// The colour of a value element (rgb, srgb, spectrum, blackbody, float); none for other elements.
std::optional<Rgb> color_of(const SceneElement& value);
/// A number that was given as a colour: any component of grey, else the luminance.
inline double grey_of(const Rgb& c) {
  return double(c.x == c.y && c.y == c.z ? c.x : luminance(c));
}
/// The matrix of a `transform`, in Imath's convention.
M44d transform_of(const SceneElement& transform);
/// Numbers separated by blanks and commas; at most `most`. Throws SceneError with the element.
std::vector<double> numbers_in(const SceneElement& at, const std::string& text,
                               std::size_t most = 4096);
double number_in(const SceneElement& at, const std::string& text);

}  // namespace lacuna::mitsuba
