#pragma once

#include <string>
#include <vector>

#include "renderer/scene/camera.h"
#include "renderer/scene/scene.h"

namespace lacuna {

/// Warns if `paths` light paths, of all iterations together, are too few to reach the emitters that
/// light the visible surfaces.
///
/// At a point, emitter i gives c_i of the direct light; light paths start on it with probability
/// p_i. An estimate of the sum of all c_i by one path is c_i / p_i, and the relative variance of N
/// paths together is (sum_i c_i^2 / p_i / (sum_i c_i)^2 - 1) / N. They count as
///
///   N_e = N (sum_i c_i)^2 / sum_i (c_i^2 / p_i)
///
/// paths from emitters that matter there. Where N_e < 1 the relative standard error is above 1: if
/// one emitter lights the point, no path at all starts on it with a probability of e^-N_e > .37:
/// the point is then too dark, and the picture does not show it. Both sums are estimated with a few
/// emitters for each point of a coarse grid of the film. Requires SceneNeeds::light_tree.
std::vector<std::string> unreached_emitters(const Scene& scene, const Camera& camera, double paths);

}  // namespace lacuna
