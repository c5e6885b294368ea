#pragma once

#include <vector>

#include "analysis/skeleton/surface_lookup.h"
#include "base/parallel/thread_pool.h"
#include "renderer/scene/camera.h"
#include "renderer/scene/scene.h"

namespace lacuna {

/// The luminance of the emitted power that arrives unscattered at the surfaces of each of `count`
/// parts of the empty space, estimated by `rays` rays from the emitters (Noel 2015, eq. 172-176).
/// `lookup` maps a surface to the index of its part, as a node map does. The result does not depend
/// on the number of threads.
std::vector<double> arriving_power(const Scene& scene, const SurfaceLookup& lookup,
                                   std::size_t count, int rays, const ThreadPool& pool);

/// The part of the empty space from which the emitters emit the most power; emitters at infinity
/// have none. Where all are at infinity: the part in which the most power arrives. Parameters as of
/// arriving_power().
std::uint32_t brightest_part(const Scene& scene, const SurfaceLookup& lookup, std::size_t count,
                             int rays, const ThreadPool& pool);

/// The fraction of the picture in which each part's surfaces are directly visible, without mirrors:
/// the power that arrives from an eye that emits importance. Otherwise as arriving_power().
std::vector<double> arriving_importance(const Scene& scene, const Camera& camera,
                                        const SurfaceLookup& lookup, std::size_t count, int rays,
                                        const ThreadPool& pool);

}  // namespace lacuna
