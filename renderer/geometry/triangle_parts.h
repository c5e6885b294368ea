#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "renderer/geometry/scene_data.h"

namespace lacuna {

/// Some consecutive triangles of a mesh, [first, last): a share of a parallel loop.
struct TrianglePart {
  std::uint32_t mesh = 0, first = 0, last = 0;
};

/// All triangles of `meshes` in parts of at most 2^14, in order.
inline std::vector<TrianglePart> triangle_parts(std::span<const Mesh> meshes) {
  constexpr std::uint32_t most = 1U << 14;
  std::vector<TrianglePart> parts;
  for (std::uint32_t m = 0; m < meshes.size(); ++m) {
    const auto count = static_cast<std::uint32_t>(meshes[m].triangles.size());
    for (std::uint32_t t = 0; t < count; t += most) {
      parts.push_back({m, t, std::min(t + most, count)});
    }
  }
  return parts;
}

}  // namespace lacuna
