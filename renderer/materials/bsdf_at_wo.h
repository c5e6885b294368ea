#pragma once

#include "renderer/materials/bsdf.h"
#include "renderer/materials/mean_weights.h"

namespace lacuna {

/// An opaque BSDF with a fixed wo, evaluated for eight directions wi at once.
class BsdfAtWo {
 public:
  /// `bsdf` must not transmit, and outlives this.
  BsdfAtWo(const Bsdf& bsdf, const V3f& wo);

  /// Bsdf::eval(wo, w, Transport::radiance) for unit `w`, times `factor`.
  Float8x3 eval(const Float8x3& w) const {
    const Float8 cos_i = w.x * n_.x + w.y * n_.y + w.z * n_.z;
    const Float8 side = w.x * side_.x + w.y * side_.y + w.z * side_.z;
    if (extended_ != nullptr) return one_by_one(w);
    const Mask8 reflected = side > 0 && cos_i > 0;
    if (layered_) {
      const Float8x3 f = keep_where(reflected, layered(w, cos_i));
      return {f.x * factor.x, f.y * factor.y, f.z * factor.z};
    }
    const Float8 cosine = keep_where(reflected, cos_i);
    const Rgb f = diffuse_ * factor;
    return {f.x * cosine, f.y * cosine, f.z * cosine};
  }
  Rgb factor{1, 1, 1};

 private:
  Float8x3 one_by_one(const Float8x3& w) const;
  Float8x3 layered(const Float8x3& w, Float8 cos_i) const;
  Float8x3 facets(const Float8x3& w, Float8 cos_i) const;

  V3f wo_, side_, n_;
  float cos_o_;
  Rgb diffuse_;   // over pi
  bool layered_;  // has facets
  Layer layer_;
  float through_o_ = 1;  // of the layer
  MeanWeights means_;
  Interface interface_;
  const Bsdf* extended_;  // a BSDF with Lobes::further; null: another
};

}  // namespace lacuna
