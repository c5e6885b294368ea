#pragma once

#include <memory>

#include "jobs/import/pbrt/pbrt_context.h"

namespace lacuna::pbrt {

/// Bilinear patches. A parallelogram is two triangles; other patches are divided, with a note where
/// they are not flat.
std::shared_ptr<const ImportedMesh> bilinear_mesh(Context& context, const Parameters& p);

/// Loop's subdivision surface at `levels`, with the vertices on its limit and normals of the
/// triangles' mean.
std::shared_ptr<const ImportedMesh> loop_subdivision(Context& context, const Parameters& p);

}  // namespace lacuna::pbrt
