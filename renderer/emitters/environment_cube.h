#pragma once

#include <memory>

#include "base/parallel/thread_pool.h"
#include "renderer/emitters/environment.h"
#include "renderer/geometry/scene_data.h"

namespace lacuna {

/// The environment of SceneData::environment, which exists and whose faces are decoded. With n the
/// side of a face, it has 8 n x 4 n texels, which are pi / (4 n) high: one of a face is 2 / n wide
/// at its centre and 1 / n at the middle of an edge. Each is the mean radiance over its solid
/// angle. Throws SceneError for faces of other sizes and for colours over an alpha of 0.
std::unique_ptr<Environment> environment_of_cube(const SceneData& scene, const ThreadPool& pool);

}  // namespace lacuna
