#pragma once

#include "renderer/core/vec.h"

namespace lacuna {

// The Beckmann distribution of facet normals (Walter et al. 2007, "Microfacet Models for
// Refraction"): slopes are normally distributed. `alpha`: the widths along x and y, each at least
// ggx_min_alpha. Directions are unit, in the local frame with the normal along z.

/// Density of facet normals `m`, per projected area; 0 below the surface.
float beckmann_d(const V3f& m, const V2f& alpha);

/// Smith's masking G1(w) / w.z, w.z > 0, in closed form (Heitz 2014, eq. 80): finite at grazing
/// angles.
float beckmann_g1_over_cos(const V3f& w, const V2f& alpha);

/// Samples a facet normal visible from `wo`, wo.z > 0, with density G1(wo) (wo.m) D(m) / wo.z
/// (Heitz and d'Eon 2014, "Importance Sampling Microfacet-Based BSDFs using the Distribution of
/// Visible Normals").
V3f beckmann_sample_visible(const V3f& wo, const V2f& alpha, const V2f& u);

}  // namespace lacuna
