#pragma once

#include <optional>
#include <string>

#include "jobs/import/pbrt/pbrt_context.h"

namespace lacuna::pbrt {

/// Reads `Texture "name" "float" "imagemap" ...` into context.names. Patterns that
/// ImportedTexture cannot hold are replaced by their mean, with a note. Throws SceneError.
void read_texture(Context& context, const std::string& name, const std::string& type,
                  const std::string& pattern, const Parameters& parameters);

/// A parameter that may be a number or a float texture. None if it is missing.
std::optional<ImportedValue> float_value(const Context& context, const Parameters& parameters,
                                         const char* name);
/// A parameter that may be a colour, a spectrum or a spectrum texture. None if it is missing.
std::optional<ImportedValue> colour_value(const Context& context, const Parameters& parameters,
                                          const char* name);
inline ImportedValue colour_value(const Context& context, const Parameters& parameters,
                                  const char* name, float grey) {
  return colour_value(context, parameters, name)
      .value_or(ImportedValue{Rgb(grey, grey, grey), nullptr});
}

/// A picture that a statement names, as it decodes without further parameters. None if the file is
/// missing.
std::shared_ptr<ImportedTexture> picture(Context& context, const Parameters& parameters,
                                         const std::string& file);

}  // namespace lacuna::pbrt
