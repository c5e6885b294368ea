#pragma once

#include <cstdint>

#include "renderer/path/endpoints.h"

namespace lacuna {

/// The data of a light path's vertex that merging needs. Merging uses the BSDF of the eye vertex.
struct Photon {
  V3f x{0, 0, 0};
  V3f ng{0, 0, 0};  ///< unit; geometric normal of the surface
  V3f wp{0, 0, 0};  ///< unit, to the previous vertex of the light path
  Rgb throughput{0, 0, 0};
  float p_fwd = 0;          ///< Vertex::p_fwd
  std::uint16_t index = 0;  ///< of the vertex on its path, >= 1
  bool prev_connectible : 1 = true;
  bool caustic : 1 = false;  ///< PhotonMap::keep()
  std::uint8_t letters = 0;  ///< Vertex::letters
  double mis_partial = 0;    ///< Vertex::mis_partial
};
static_assert(sizeof(Photon) == 64);  // a cache line

/// The vertex `v`, number `index` >= 1 of a light path.
inline Photon photon(const Vertex& v, int index) {
  return {.x = v.surface.x,
          .ng = v.surface.ng,
          .wp = v.wp,
          .throughput = v.throughput,
          .p_fwd = v.p_fwd.value,
          .index = static_cast<std::uint16_t>(index),
          .prev_connectible = v.prev_connectible,
          .letters = v.letters,
          .mis_partial = v.mis_partial};
}

/// Whether both points may lie on one surface: their normals differ by less than 60 degrees. Where
/// they differ by more, the disc pi r^2 that photons are counted in is not the surface's.
inline bool on_one_surface(const V3f& ng, const Photon& p) {
  return std::abs(dot(ng, p.ng)) > 0.5F;
}

/// What `eye` scatters of one photon's power: the product of both throughputs and the BSDF, which
/// SurfaceEndpoint::scatter() has times the cosine. Over pi r^2 and the number of light paths it
/// estimates the radiance that the path carries (Georgiev et al. 2012, eq. 7; Noel 2015, 4.5).
/// The cosine is the photon's, because the probability that a photon arrives falls with it: the
/// quotient stays bounded if the eye vertex lies on another triangle. Black at grazing
/// incidence, where the cosine is a rounding error.
inline Rgb merged(const SurfaceEndpoint& eye, const Photon& p) {
  const float cosine = abs_dot(p.ng, p.wp);
  if (!(cosine > cos_rounding)) return Rgb(0, 0, 0);
  return eye.scatter(p.wp) * p.throughput / cosine;
}

/// The MIS weight of merging the eye vertex with the photon (mis.h). Both sums are relative to the
/// density of merging, p_{j+1} g_j pi r^2 = p_j p_j(x_j) pi r^2. They treat the eye vertex and the
/// photon as one point.
inline double merge_weight(const SurfaceEndpoint& eye, const Photon& p, const SampleCounts& n) {
  const double light_rev = p.mis_partial > 0 ? eye.pdf(p.wp) : 0.0;
  const double light =
      mis_partial_sum(light_side(n), p.index, p.prev_connectible, light_rev, p.mis_partial) /
      double(p.p_fwd);
  const double eye_rev = eye.mis_partial() > 0 ? eye.pdf_rev(p.wp) : 0.0;
  const double from_eye =
      mis_partial_sum(eye_side(n), eye.index, eye.prev_connectible(), eye_rev, eye.mis_partial()) /
      eye.p_fwd();
  return mis_weight(n.merge, light, from_eye);
}

}  // namespace lacuna
