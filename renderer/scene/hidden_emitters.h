#pragma once

#include <string>
#include <vector>

#include "renderer/scene/scene.h"

namespace lacuna {

/// Warns of emitters with another surface in their plane, or so close to it that offset rays cannot
/// separate them: samples of the emitter contribute, rays hit the other surface, and methods
/// disagree. Tests a few points, from a small distance, of at most 2^14 emitting triangles spread
/// over all; triangles too small for the test are skipped. Requires SceneNeeds::emission.
std::vector<std::string> hidden_emitters(const Scene& scene);

}  // namespace lacuna
