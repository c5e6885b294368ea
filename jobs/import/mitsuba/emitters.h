#pragma once

#include "jobs/import/mitsuba/read_context.h"

namespace lacuna::mitsuba {

/// Adds an emitter that is no shape to the scene: point, spot, directional, constant, envmap.
/// Throws SceneError for others; those of the sky are left out and noted if missing things are
/// skipped.
void add_emitter(ReadContext& context, MissingFiles missing, const SceneElement& element,
                 ImportedScene& scene);

}  // namespace lacuna::mitsuba
