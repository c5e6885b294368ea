#pragma once

#include <map>
#include <memory>

#include "jobs/import/mitsuba/read_context.h"

namespace lacuna::mitsuba {

/// A colour or number with what else a texture says.
struct TexturedValue {
  ImportedValue value;
  bool vertex_colors = false;
};

/// Reads textures, each once.
class Textures {
 public:
  explicit Textures(ReadContext& context) : context_(context) {}

  /// The parameter of a plugin: a colour or a texture.
  TexturedValue value(const Parameters& of, std::string_view name, const Rgb& fallback);
  /// A texture's element. `raw`: its values are numbers, not colours, unless it says otherwise.
  TexturedValue texture(const SceneElement& element);

 private:
  TexturedValue read(const SceneElement& element);
  TexturedValue read_bitmap(const SceneElement& element);
  TexturedValue read_checkerboard(const SceneElement& element);
  TexturedValue read_scale(const SceneElement& element);
  /// Of a texture that is not read, with a note.
  Rgb mean_of(const Parameters& p);

  ReadContext& context_;
  std::map<const SceneElement*, TexturedValue> known_;
  int depth_ = 0;
};

}  // namespace lacuna::mitsuba
