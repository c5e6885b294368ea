#pragma once

#include <array>
#include <cstddef>
#include <map>
#include <optional>
#include <vector>

#include "renderer/core/vec.h"

namespace lacuna::gltf {

/// The properties of a node that an animation replaces; none: not animated.
struct NodePose {
  std::optional<std::array<double, 3>> translation, scale;
  std::optional<std::array<double, 4>> rotation;  ///< x, y, z, w; of length 1
  std::optional<std::vector<double>> weights;     ///< of morph targets
};

/// By the index of the node. Empty: the file's static pose.
using Pose = std::map<std::size_t, NodePose>;

/// For each skin the transforms of its joints in a pose, from the mesh's coordinates to the
/// world's.
using Skins = std::vector<std::vector<M44d>>;

}  // namespace lacuna::gltf
