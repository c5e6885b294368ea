#pragma once

#include <string>

#include "renderer/geometry/scene_data.h"
#include "renderer/settings/scene_settings.h"

namespace lacuna {

/// Applies `change` to all materials of its name. `file` names the scene in messages. Throws
/// SceneError if no material has that name.
void change_material(SceneData& scene, const MaterialChange& change, const std::string& file);

}  // namespace lacuna
