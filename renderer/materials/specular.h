#pragma once

#include "renderer/core/vec.h"

namespace lacuna {

// Fresnel reflectance, and the directions of a mirror and of a smooth interface. `eta` is always
// the refractive index on the far side over that on the side of `w`; `cos` = dot(w, m) > 0.

/// Schlick's (1 - cos)^5 (Schlick 1994, eq. 15).
template <class T>
T schlick_weight(const T& cos) {
  using std::max;
  const T x = max(T(0.0F), T(1 - cos));
  const T x2 = x * x;
  return x2 * x2 * x;
}

/// Reflectance of a dielectric at normal incidence; `ior` >= 1.
inline float normal_reflectance(float ior) {
  const float r = (ior - 1) / (ior + 1);
  return r * r;
}

/// Fresnel reflection of unpolarised light at a smooth dielectric interface.
struct Fresnel {
  float reflectance;  ///< [0, 1]; exactly 1 under total internal reflection
  float cos_t;        ///< >= 0: cosine on the far side
  bool total;         ///< whether there is total internal reflection
};

/// Fresnel's exact equations. The cosine on the far side is computed from (eta^2 - 1) + cos^2, so
/// that directions stay exactly straight for eta = 1.
inline Fresnel fresnel_dielectric(float cos, float eta) {
  const float t2 = (eta - 1) * (eta + 1) + cos * cos;
  if (t2 <= 0) return {1, 0, true};
  const float t = std::sqrt(t2);  // eta * cos_t
  const float cos_t = t / eta;
  const float perpendicular = (cos - t) / (cos + t);
  const float parallel = (eta * cos - cos_t) / (eta * cos + cos_t);
  return {std::min(1.0F, 0.5F * (perpendicular * perpendicular + parallel * parallel)), cos_t,
          false};
}

/// Reflectance of a conductor with the complex index of refraction `eta` + i `k` over that of the
/// outside, exactly, for unpolarised light (Born and Wolf, sec. 14.2, solved for the squared
/// moduli).
inline float fresnel_conductor(float cos, float eta, float k) {
  const float cos2 = cos * cos, sin2 = 1 - cos2;
  const float real = eta * eta - k * k - sin2;                       // of n^2 - sin^2
  const float ab2 = std::sqrt(real * real + 4 * eta * eta * k * k);  // a^2 + b^2, its modulus
  const float a2 = 2 * cos * std::sqrt(std::max(0.0F, 0.5F * (ab2 + real)));  // 2 a cos
  const float perpendicular = (ab2 - a2 + cos2) / (ab2 + a2 + cos2);
  const float c = cos2 * ab2 + sin2 * sin2, d = a2 * sin2;
  return 0.5F * perpendicular * (1 + (c - d) / (c + d));
}

/// Mean of the dielectric reflectance over light from all around, 2 cos d cos: closed form
/// (Walsh 1926; Egan and Hilgeman 1979, "Optical Properties of Inhomogeneous Materials"). For `ior`
/// below 1 by reciprocity: 1 - mean is ior^-2 times as much from the other side.
double mean_dielectric_reflectance(double ior);

/// The mirror image of `w` about `m`; both directions leave the surface.
inline V3f reflect(const V3f& w, const V3f& m) { return 2 * dot(w, m) * m - w; }

/// The refracted direction, on the far side of `m` (Snell); `cos_t` from fresnel_dielectric().
/// Normalised, because rounding errors of `w` grow by 1 / eta on leaving a dense medium.
inline V3f refract(const V3f& w, const V3f& m, float eta, float cos_t) {
  const float inv = 1 / eta;
  const V3f t = (dot(w, m) * inv - cos_t) * m - w * inv;
  return t * (1 / std::sqrt(t.length2()));
}

}  // namespace lacuna
