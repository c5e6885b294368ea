#include "renderer/many_lights/vpl_contributions.h"

#include <limits>

namespace lacuna {

void VplContributions::evaluate(const ShadingPoint& at, std::size_t block, Terms& out,
                                std::uint64_t of, float weight) const {
  const std::uint64_t there = lights_.mask(block);
  of &= there;
  out.weight = weight;
  if (const DiffuseBlock* diffuse = lights_.diffuse(block)) {
    diffuse_terms(at, *diffuse, of, out);
  } else {
    for (int i = 0; i < Lanes::size; ++i) {
      const bool wanted = (of >> i & 1) != 0;
      const Rgb t = wanted ? general(at, lights_.general(block, i)) : Rgb(0, 0, 0);
      out.r[i] = t.x, out.g[i] = t.y, out.b[i] = t.z;
    }
  }
  if (of != there || weight != 1) weigh(of, weight, out);
  finish(out);
}

void PointLanes::add(const ShadingPoint& p) {
  const V3f x = p.vertex->surface.x;
  const V3f n = p.vertex->side();
  const int i = static_cast<int>(size_++);
  x_[i] = x.x, y_[i] = x.y, z_[i] = x.z;
  nx_[i] = n.x, ny_[i] = n.y, nz_[i] = n.z;
}

template <class LeavesOut>
std::uint64_t PointLanes::all_but(LeavesOut&& leaves_out) const {
  std::uint64_t out = 0;
  for (int k = 0; 8 * k < static_cast<int>(size_); ++k) {
    out |= std::uint64_t{leaves_out(x(k), n(k))} << (8 * k);
  }
  return all() & ~out;
}

std::uint64_t PointLanes::may_be_lit(const BlockBounds& bounds) const {
  return all_but([&](const Float8x3& x, const Float8x3& n) {
    return movemask(bounds.facing_away(x)) | movemask(bounds.behind(x, n));
  });
}

std::uint64_t PointLanes::may_be_near(const BlockBounds& bounds, float distance) const {
  return all_but([&](const Float8x3& x, const Float8x3&) {
    return movemask(bounds.further_than(distance, x));
  });
}

/// Weights the sampled lights; sets unsampled ones of a group of eight to black.
void VplContributions::weigh(std::uint64_t of, float weight, Terms& out) {
  for (int k = 0; k < Lanes::groups; ++k) {
    const auto bits = static_cast<unsigned>(of >> (8 * k) & 0xff);
    if (bits == 0) continue;  // already black
    const Mask8 mask = mask_from_bits(bits);
    for (Lanes* const channel : {&out.r, &out.g, &out.b}) {
      channel->set(k, keep_where(mask, channel->eight(k) * Float8(weight)));
    }
  }
}

void VplContributions::diffuse_terms(const ShadingPoint& at, const DiffuseBlock& from,
                                     std::uint64_t of, Terms& out) const {
  const V3f x = at.vertex->surface.x;
  const V3f ng = at.vertex->surface.ng;
  // Path tracing cannot hit these lights, so it could not compensate for a bound.
  const float bound = from.points ? std::numeric_limits<float>::infinity() : bound_;
  for (int k = 0; k < Lanes::groups; ++k) {
    if ((of >> (8 * k) & 0xff) == 0) {
      for (Lanes* const channel : {&out.r, &out.g, &out.b}) channel->set(k, 0.0F);
      continue;
    }
    const Float8x3 d{from.x.eight(k) - x.x, from.y.eight(k) - x.y, from.z.eight(k) - x.z};
    const Float8 inv = 1 / sqrt(length2(d));
    const Float8x3 w = d * inv;
    const Float8 cos_g = from.points
                             ? Float8(1.0F)
                             : -dot(w, {from.gx.eight(k), from.gy.eight(k), from.gz.eight(k)});
    const Float8 cos_s = -dot(w, {from.sx.eight(k), from.sy.eight(k), from.sz.eight(k)});
    const Float8 over_d2 = cos_g * inv * inv;
    Float8 t = over_d2 * select(cos_s > 0, from.shading_cosine_ratio.eight(k), 1);
    const Float8 geometric = abs(w.x * ng.x + w.y * ng.y + w.z * ng.z) * over_d2;
    const Mask8 above = geometric > bound;
    if (any(above)) t = select(above, t * bound / geometric, t);  // bounded_share()
    // At the light's own position everything is NaN and all comparisons are false.
    t = keep_where(over_d2 > 0, t);
    const Float8x3 f = at.bsdf.eval(w);
    out.r.set(k, f.x * from.r.eight(k) * t);
    out.g.set(k, f.y * from.g.eight(k) * t);
    out.b.set(k, f.z * from.b.eight(k) * t);
  }
}

Rgb VplContributions::general(const ShadingPoint& at, const GeneralLight& light) const {
  const SurfaceEndpoint eye{*at.vertex, at.depth, Transport::radiance, guide_};
  return light.with_end(guide_, [&](const auto& end) -> Rgb {
    const Connection c = connect(eye, end);
    if (!c) return Rgb(0, 0, 0);
    const Rgb t = c.contribution * lights_.share();
    // Path tracing cannot hit these lights, so it could not compensate for a bound.
    if (c.infinite || light.delta()) return t;
    const double g = eye.area_factor(c.w) * end.area_factor(c.w) / double(c.distance2);
    return t * bounded_share(static_cast<float>(g), bound_);
  });
}

void VplContributions::finish(Terms& out) {
  for (int k = 0; k < Lanes::groups; ++k) {
    out.luminance.set(k, lacuna::luminance(out.r.eight(k), out.g.eight(k), out.b.eight(k)));
  }
  out.rejected = 0;
  out.lit = positive(out.luminance);
  // Infinity and NaN propagate to the sum, which is nearly always finite.
  if (sum(out.luminance) <= std::numeric_limits<float>::max()) return;
  for (int i = 0; i < Lanes::size; ++i) {
    if (is_finite(V3f(out.r[i], out.g[i], out.b[i]))) continue;
    out.r[i] = out.g[i] = out.b[i] = out.luminance[i] = 0;
    out.rejected |= std::uint64_t{1} << i;
  }
  out.lit &= ~out.rejected;
}

namespace {

/// The end of a segment from `start` to light `i` of a block, which is at `x` with the normal `g`.
V3f end_on(const DiffuseBlock& block, int i, const V3f& x, const V3f& g, const V3f& start) {
  if (block.points) return x;
  return offset_end(x, g, block.offset[i], g, (x - start).length());
}

}  // namespace

Ray VplContributions::ray_from_side(const ShadingPoint& at, std::size_t block, int i) const {
  const Surface& surface = at.vertex->surface;
  const V3f n = at.vertex->side();
  const V3f start = offset_origin(surface.x, surface.ng, surface.offset, n);
  const VplGeometry light = lights_.geometry(block, i);
  if (light.infinite) return {start, light.x};
  if (const DiffuseBlock* from = lights_.diffuse(block)) {
    const V3f end = end_on(*from, i, light.x, light.n, start);
    return {start, end - start, 1.0F};
  }
  return lights_.general(block, i).with_end(guide_, [&](const auto& end) -> Ray {
    const V3f side = light.n == V3f(0, 0, 0) ? start - light.x : light.n;
    return {start, end.end(side, (light.x - start).length()) - start, 1.0F};
  });
}

Ray VplContributions::ray(const ShadingPoint& at, std::size_t block, int i) const {
  const SurfaceEndpoint eye{*at.vertex, at.depth, Transport::radiance, guide_};
  if (const DiffuseBlock* from = lights_.diffuse(block)) {
    const V3f x(from->x[i], from->y[i], from->z[i]);
    const V3f g(from->gx[i], from->gy[i], from->gz[i]);
    const V3f start = eye.origin(x - eye.x());
    const V3f end = end_on(*from, i, x, g, start);
    return {start, end - start, 1.0F};
  }
  return lights_.general(block, i).with_end(
      guide_, [&](const auto& end) { return shadow_ray(eye, end, edge_between(eye, end)); });
}

}  // namespace lacuna
