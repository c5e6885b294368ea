#pragma once

#include <optional>
#include <string>
#include <vector>

#include "renderer/scene/camera.h"
#include "renderer/scene/scene.h"

namespace lacuna {

/// Warns of point and spot lights that lie in a surface: it is undefined on which side such a light
/// is, so it lights both.
std::vector<std::string> lights_in_surfaces(const Scene& scene);

/// Moves a camera that lies in surfaces off them, to the sides that it looks at, by a few rounding
/// errors, too little to be visible. Returns the surfaces that it lay in.
std::optional<SurfaceContact> leave_surfaces(CameraData& camera, const Scene& scene);

/// Warns if the film of a camera moved by leave_surfaces() also sees those surfaces from the side
/// that it left.
std::vector<std::string> look_back(const Camera& camera, const SurfaceContact& left,
                                   const Scene& scene);

}  // namespace lacuna
