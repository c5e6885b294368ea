#pragma once

#include <string>
#include <vector>

#include "renderer/scene/scene.h"

namespace lacuna {

/// Warns of transmitting solids that lie in others: light between them is refracted as if air were
/// there. Follows a ray outwards from one triangle of each of at most 4096 meshes.
std::vector<std::string> nested_solids(const Scene& scene);

}  // namespace lacuna
