#pragma once

#include "jobs/import/mitsuba/read_context.h"

namespace lacuna::mitsuba {

/// Adds a sensor: perspective, thinlens, orthographic, spherical. The first one's film is the
/// scene's picture. Others become the nearest of these or are left out, with a note.
void add_sensor(ReadContext& context, const SceneElement& element, ImportedScene& scene);
/// Of a scene without a sensor, that of Mitsuba 3: it sees all shapes along +z. None if there are
/// no shapes.
void add_default_sensor(ReadContext& context, const SceneElement& root, ImportedScene& scene);

/// Reads the limit of path length of an integrator, whatever its type.
void read_integrator(ReadContext& context, const SceneElement& element, ImportedScene& scene);

}  // namespace lacuna::mitsuba
