#include "renderer/materials/bsdf_at_wo.h"

#include <array>

namespace lacuna {

BsdfAtWo::BsdfAtWo(const Bsdf& bsdf, const V3f& wo)
    : wo_(wo),
      side_(dot(wo, bsdf.ng_) < 0 ? -bsdf.ng_ : bsdf.ng_),
      n_(bsdf.eye_normal(wo, dot(wo, bsdf.ng_))),
      cos_o_(dot(wo, n_)),
      diffuse_(bsdf.lobes_->diffuse * inv_pi),
      layered_(bsdf.lobes_->kind == Lobes::Kind::layered),
      layer_(bsdf.lobes_->layer),
      means_(layer_),
      interface_(bsdf.lobes_->interface),
      extended_(bsdf.lobes_->kind == Lobes::Kind::layered && bsdf.lobes_->further ? &bsdf
                                                                                  : nullptr) {
  if (bsdf.lobes_->kind == Lobes::Kind::black || dot(wo, bsdf.ng_) == 0) factor = Rgb(0, 0, 0);
  if (layered_) through_o_ = layer_.let_through(layer_.mean_weight(cos_o_));
}

Float8x3 BsdfAtWo::one_by_one(const Float8x3& w) const {
  alignas(32) std::array<float, 8> x, y, z;
  w.x.store(x.data()), w.y.store(y.data()), w.z.store(z.data());
  for (std::size_t i = 0; i < 8; ++i) {
    const Rgb f = extended_->eval(wo_, {x[i], y[i], z[i]}, Transport::radiance) * factor;
    x[i] = f.x, y[i] = f.y, z[i] = f.z;
  }
  return {Float8::load(x.data()), Float8::load(y.data()), Float8::load(z.data())};
}

Float8x3 BsdfAtWo::layered(const Float8x3& w, Float8 cos_i) const {
  const Float8 scale = cos_i * layer_.scale(through_o_, layer_.let_through(means_.at(cos_i)));
  const Float8x3 base{diffuse_.x * scale, diffuse_.y * scale, diffuse_.z * scale};
  return interface_.smooth() ? base : base + facets(w, cos_i);
}

Float8x3 BsdfAtWo::facets(const Float8x3& w, Float8 cos_i) const {
  const Float8x3 h = w + Float8x3{wo_.x, wo_.y, wo_.z};
  const Float8 length = sqrt(length2(h));
  const Float8x3 m = h * (1 / length);
  const Float8x3 n{n_.x, n_.y, n_.z};
  const Float8 d = ggx_d(dot(m, n), length2(cross(n, m)), interface_.alpha);
  const Float8 g = ggx_g2_over_4cos(cos_o_, cos_i, interface_.alpha);
  const Float8 share = keep_where(length >= cos_rounding, d * g);
  const Float8 weight = schlick_weight(Float8(0.5F * length));
  const auto channel = [&](float r0) { return (r0 + (interface_.r90 - r0) * weight) * share; };
  return {channel(interface_.r0.x), channel(interface_.r0.y), channel(interface_.r0.z)};
}

}  // namespace lacuna
