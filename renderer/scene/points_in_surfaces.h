#pragma once

#include <optional>
#include <string>
#include <vector>

#include "renderer/scene/camera.h"
#include "renderer/scene/scene.h"

namespace lacuna {

/// Warns of point and spot lights that lie in a surface: which of its sides such a light is on is
/// not defined, so it lights both.
std::vector<std::string> lights_in_surfaces(const Scene& scene);

/// Moves a camera that lies in surfaces off them, to the sides that it looks at; returns what it
/// lay in. By a few roundings: no picture shows it.
std::optional<SurfaceContact> leave_surfaces(CameraData& camera, const Scene& scene);

/// Warns where the film of a camera that leave_surfaces() moved also sees what it lay in from the
/// side that it left.
std::vector<std::string> look_back(const Camera& camera, const SurfaceContact& left,
                                   const Scene& scene);

}  // namespace lacuna
