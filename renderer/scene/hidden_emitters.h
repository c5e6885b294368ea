#pragma once

#include <string>
#include <vector>

#include "renderer/scene/scene.h"

namespace lacuna {

/// Warns of emitters that another surface lies in the plane of, or so close to that rays which
/// start beside surfaces do not tell them apart: samples of the emitter shine, rays meet the other
/// surface, and methods disagree. A few points of at most 2^14 emitting triangles, spread over all,
/// are looked at from a little in front; triangles too small for that are left out. Only where
/// SceneNeeds::emission was asked for.
std::vector<std::string> hidden_emitters(const Scene& scene);

}  // namespace lacuna
