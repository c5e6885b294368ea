#pragma once

#include "jobs/import/imported_scene.h"

namespace lacuna {

/// Normals of the vertices, of their triangles weighted by angles; of vertices without any (0, 0,
/// 1).
void add_smooth_normals(ImportedMesh& mesh);

/// Turns triangles over whose front is not where their normals point: in Mitsuba and in pbrt the
/// normals decide. Does nothing without normals.
void orient_by_normals(ImportedMesh& mesh);

}  // namespace lacuna
