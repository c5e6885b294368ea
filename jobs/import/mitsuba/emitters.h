#pragma once

#include "jobs/import/mitsuba/read_context.h"

namespace lacuna::mitsuba {

/// Whether an emitter of this type belongs to shapes, which may refer to it.
bool is_of_shapes(const SceneElement& emitter);

/// Adds an emitter that is no shape to the scene: point, spot, directional, constant, envmap,
/// sky, sun, sunsky. Others are left out with a note.
void add_emitter(ReadContext& context, const SceneElement& element, ImportedScene& scene);

}  // namespace lacuna::mitsuba
