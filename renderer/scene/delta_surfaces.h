#pragma once

#include <string>
#include <vector>

#include "renderer/scene/camera.h"
#include "renderer/scene/scene.h"

namespace lacuna {

/// Warns of mirrors, clear glass and smooth coats that the camera sees, for methods that connect
/// light paths to the eye: delta lobes cannot be connected, so these reflections are missing. Tests
/// a grid of camera rays. Requires SceneNeeds::materials.
std::vector<std::string> missing_reflections(const Scene& scene, const Camera& camera);

}  // namespace lacuna
