#pragma once

#include <string>

#include "analysis/geometry/triangle_soup.h"
#include "analysis/space/domain.h"
#include "renderer/geometry/scene_data.h"

namespace lacuna {

/// All triangles of a scene for the analysis of its empty space. Lights, glass and masked surfaces
/// are scene like all others.
TriangleSoup triangle_soup(const SceneData& scene);

/// SceneData::geometry_hash as 16 hexadecimal digits: the key of all analysis.
std::string geometry_key(const SceneData& scene);

/// A key of what rays can meet: the geometry, and where it has alpha masks all bytes of the scene.
std::string occluder_key(const SceneData& scene);

/// Where light starts or is seen: the camera, points of every triangle that emits on each side that
/// does, point and spot lights; `environment`, and directional lights, come from infinity.
DomainSeeds domain_seeds(const SceneData& scene, const CameraData& camera, bool environment);

}  // namespace lacuna
