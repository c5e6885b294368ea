#pragma once

#include "renderer/core/vec.h"

namespace lacuna {

/// f pi of a diffuse surface of V-shaped grooves whose slope angles have the standard deviation
/// `sigma` > 0, radians, with one interreflection (Oren and Nayar 1994, "Generalization of
/// Lambert's Reflectance Model", eqs. 30 and 31). `wo` and `wi` lie on the side of `n`; all unit.
Rgb oren_nayar(const Rgb& albedo, float sigma, const V3f& n, const V3f& wo, const V3f& wi);

}  // namespace lacuna
