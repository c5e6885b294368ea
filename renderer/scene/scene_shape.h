#pragma once

#include <string>

#include "analysis/geometry/triangle_soup.h"
#include "analysis/space/domain.h"
#include "renderer/geometry/scene_data.h"

namespace lacuna {

/// All triangles of a scene, for the analysis of its empty space, including lights, glass and
/// masked and blended surfaces.
TriangleSoup triangle_soup(const SceneData& scene);

/// SceneData::geometry_hash as 16 hexadecimal digits: the key of all analyses.
std::string geometry_key(const SceneData& scene);

/// A key of the occluders: the hash of the geometry, or of the whole content if there are alpha
/// masks.
std::string occluder_key(const SceneData& scene);

/// The seeds of the domain: the camera, points on every emitting side of every emitting triangle,
/// point and spot lights; with `environment` or directional lights, light from infinity.
DomainSeeds domain_seeds(const SceneData& scene, const CameraData& camera, bool environment);

}  // namespace lacuna
