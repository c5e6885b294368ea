#pragma once

#include "renderer/path/light_vertices.h"
#include "renderer/settings/connections_settings.h"

namespace lacuna {

/// w_n(y) of Noel 2015, eq. 187, for all vertices LightVertices::at(s, .): what the light path
/// carries, as luminance, over the squared distance to `x`, which is not taken smaller than
/// `least_distance` (scene units, > 0). Of infinite emitters: without the distance. 0 where
/// `sides` is facing and the vertex scatters nothing to the side that `x` is on.
std::vector<double> node_weights(const LightVertices& lights, int s, const V3f& x,
                                 double least_distance, LightSides sides);

/// The rays that meet nothing where `x`, a point in empty space, sees those vertices.
std::vector<Ray> rays_to(const LightVertices& lights, int s, const V3f& x);

}  // namespace lacuna
