#pragma once

#include <vector>

#include "analysis/parallel/thread_pool.h"
#include "analysis/skeleton/surface_lookup.h"
#include "renderer/scene/scene.h"

namespace lacuna {

/// Of each of `count` parts of the empty space the emitted power (its luminance) that arrives,
/// without being scattered on its way, at the surfaces that belong to it, estimated by `rays` rays
/// that leave the lights (Noel 2015, eq. 172-176). `lookup` is into a grid of the parts' numbers,
/// as a node mapping grid is. The same for any number of threads.
std::vector<double> arriving_power(const Scene& scene, const SurfaceLookup& lookup,
                                   std::size_t count, int rays, const ThreadPool& pool);

}  // namespace lacuna
