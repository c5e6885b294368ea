#pragma once

#include "jobs/import/mitsuba/read_context.h"

namespace lacuna::mitsuba {

/// Adds an emitter that is no shape to the scene: point, spot, directional, constant, envmap,
/// sky, sun, sunsky. Throws SceneError for others.
void add_emitter(ReadContext& context, const SceneElement& element, ImportedScene& scene);

}  // namespace lacuna::mitsuba
