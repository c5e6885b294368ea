#pragma once

#include "renderer/materials/gltf_material.h"

namespace lacuna {

/// The bits of a point of a surface: what chooses between the parts of a mixture.
using PointBits = std::array<std::uint32_t, 5>;

/// surface_params() of a material with LACUNA_materials. Of a mixture one part, with probability
/// its weight, chosen by the hash of `point`: the mixture is a fine pattern of its parts, the same
/// for every path through the point, so that the mean over points is exact in every method.
/// SurfaceParams::medium is that of `material`.
SurfaceParams lacuna_params(const Material& material, Textures textures,
                            const std::array<V2f, 2>& uv, const PointBits& point);

}  // namespace lacuna
