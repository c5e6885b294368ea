#pragma once

#include "renderer/path/light_vertices.h"
#include "renderer/settings/connections_settings.h"

namespace lacuna {

/// w_n(y) of Noel 2015, eq. 187, for all vertices LightVertices::at(s, .): the luminance of the
/// light path's throughput over max(distance to `x`, `least_distance`)^2, in scene units;
/// `least_distance` > 0. For infinite emitters only the luminance. 0 if `sides` is facing and the
/// vertex does not scatter to the side of `x`.
std::vector<double> node_weights(const LightVertices& lights, int s, const V3f& x,
                                 double least_distance, LightSides sides);

/// The shadow ray from `x`, a point in empty space, to LightVertices::at(s, i).
Ray ray_to(const LightVertices& lights, int s, std::size_t i, const V3f& x);
/// The shadow rays to all vertices LightVertices::at(s, .).
std::vector<Ray> rays_to(const LightVertices& lights, int s, const V3f& x);

}  // namespace lacuna
