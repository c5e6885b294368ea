#include "renderer/emitters/light_le_sample.h"

#include "renderer/core/frame.h"
#include "renderer/materials/lambert.h"

namespace lacuna {

namespace {

/// The unit direction at an angle to `axis` with 1 - cos = `x`, at the azimuth 2 pi `u`.
V3f around(const V3f& axis, float x, float u) {
  const float s = std::sqrt(x * (2 - x));
  const float phi = 2 * pi * u;
  return Frame(axis).to_world({s * std::cos(phi), s * std::sin(phi), 1 - x});
}

/// A uniform unit direction.
V3f everywhere(const V2f& u) { return around(V3f(0, 0, 1), 2 * u.x, u.y); }

/// Sets the throughput of `l` for a point that emits `emitted`, cosine included; none if it is
/// black.
std::optional<LightLeSample> with_throughput(const Rgb& emitted, LightLeSample l,
                                             const EmitterPoint& e) {
  if (is_black(emitted) || !l.pdf.positive() || !e.pdf.positive()) return std::nullopt;
  l.throughput = emitted / l.pdf.value / e.pdf.value;
  return l;
}

std::optional<LightLeSample> sample_spot(const EmitterPoint& e, Rng& rng) {
  const V2f u = rng.next2();
  const float x = e.cones.sample(u.x);
  // Falloff from the sampled angle: at the edge of a narrow cone, the rounded direction may lie
  // outside.
  const V3f w = around(e.ng, x, u.y);
  return with_throughput(e.emission * e.cones.falloff(x),
                         {.ray = {e.origin(w), w}, .pdf = e.cones.pdf()}, e);
}

/// A point on the sides of `box` that face unit `w`, uniform in projected area.
V3d sample_silhouette(const Bounds& box, const V3f& w, Rng& rng) {
  const V3d sides = box.sides_across(w);
  const auto [choice, at] = rng.next_choice_and_point();
  double u = choice * (sides.x + sides.y + sides.z);
  int k = 0;
  while (k < 2 && u >= sides[k]) u -= sides[k++];
  V3d p;
  const int i = (k + 1) % 3;
  const int j = (k + 2) % 3;
  p[k] = w[k] > 0 ? box.high[k] : box.low[k];
  p[i] = box.low[i] + double(at.x) * (box.high[i] - box.low[i]);
  p[j] = box.low[j] + double(at.y) * (box.high[j] - box.low[j]);
  return p;
}

Ray ray_from_infinity(const V3f& to_light, const Bounds& scene, Rng& rng) {
  // Start beyond the box by its radius, so that the ray also hits surfaces on its sides.
  const V3d from = sample_silhouette(scene, to_light, rng) + V3d(to_light) * scene.radius();
  return {V3f(from), -to_light};
}

}  // namespace

std::optional<LightLeSample> sample_Le(const EmitterPoint& e, const Bounds& scene, Rng& rng) {
  LightLeSample l;
  float cosine = 1;
  switch (e.kind) {
    case EmitterPoint::Kind::area: {
      const bool back = e.both_sides && rng.next() < 0.5F;
      const V3f w = sample_cosine(back ? -e.ng : e.ng, rng.next2());
      l.ray = {e.origin(w), w};
      cosine = abs_dot(w, e.ng);
      break;
    }
    case EmitterPoint::Kind::point: {
      const V3f w = everywhere(rng.next2());
      l.ray = {e.origin(w), w};
      break;
    }
    case EmitterPoint::Kind::spot:
      return sample_spot(e, rng);
    default:
      if (!(e.across > 0)) return std::nullopt;
      l.ray = ray_from_infinity(e.x, scene, rng);
  }
  l.pdf = e.pdf_Le(l.ray.d);
  return with_throughput(e.towards(l.ray.d) * cosine, l, e);
}

}  // namespace lacuna
