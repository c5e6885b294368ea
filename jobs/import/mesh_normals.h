#pragma once

#include "jobs/import/imported_scene.h"

namespace lacuna {

/// Normals of the vertices, of their triangles weighted by angles; of vertices without any (0, 0,
/// 1).
void add_smooth_normals(ImportedMesh& mesh);

/// The normals of a mesh that has some, at unit length; those of length 0 or that are not finite
/// become those of add_smooth_normals().
std::vector<V3f> unit_normals(const ImportedMesh& mesh);

/// Turns triangles over whose front is not where their normals point: in Mitsuba and in pbrt the
/// normals decide. Does nothing without normals.
void orient_by_normals(ImportedMesh& mesh);

}  // namespace lacuna
