#pragma once

#include "renderer/geometry/scene_data.h"
#include "renderer/settings/scene_settings.h"

namespace lacuna {

/// Adds particles to a scene's lights.
void add_particles(SceneData& scene, const ParticleSettings& settings);

}  // namespace lacuna
