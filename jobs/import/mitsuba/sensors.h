#pragma once

#include "jobs/import/mitsuba/read_context.h"

namespace lacuna::mitsuba {

/// Adds a sensor: perspective, thinlens, orthographic. The first one's film is the scene's picture.
/// Throws SceneError for others.
void add_sensor(ReadContext& context, const SceneElement& element, ImportedScene& scene);

/// Reads the limit of path length of an integrator, whatever its type.
void read_integrator(ReadContext& context, const SceneElement& element, ImportedScene& scene);

}  // namespace lacuna::mitsuba
