#include "renderer/materials/lacuna_params.h"

#include "renderer/geometry/alpha_mask.h"

namespace lacuna {
namespace {

using Base = ExactSurface::Base;

Base base_of(LacunaMaterial::Type type) {
  switch (type) {
    case LacunaMaterial::Type::diffuse:
      return Base::diffuse;
    case LacunaMaterial::Type::conductor:
      return Base::conductor;
    case LacunaMaterial::Type::dielectric:
      return Base::dielectric;
    case LacunaMaterial::Type::thin_dielectric:
      return Base::thin_dielectric;
    case LacunaMaterial::Type::plastic:
      return Base::plastic;
    case LacunaMaterial::Type::glossy:
      return Base::glossy;
    default:
      return Base::gltf;
  }
}

/// A part of a mixture, with its weight over the probability of its choice; none: it absorbs.
struct ChosenPart {
  const Material* material = nullptr;
  Rgb scale{1, 1, 1};
};

/// The lookups and choices at one point.
class PointParams {
 public:
  PointParams(Textures textures, const std::array<V2f, 2>& uv, const PointBits& point)
      : textures_(textures), uv_(uv), point_(point) {}

  SurfaceParams of(const Material& m) {
    if (!m.lacuna) {
      SurfaceParams p = surface_params(m, textures_, uv_);
      p.exact.emplace();
      return p;
    }
    const LacunaMaterial& l = *m.lacuna;
    SurfaceParams p;
    if (l.type == LacunaMaterial::Type::mixture) {
      const ChosenPart part = choose(l);
      p = part.material != nullptr ? of(*part.material) : black();
      p.exact->scale *= part.scale;
    } else if (l.type == LacunaMaterial::Type::coating) {
      p = of(*l.parts[0].material);
      p.exact->coating = CoatingParams{l.ior, roughness(l), reflectance(l), l.optical_depth};
    } else {
      p.base_color = base_color(m, textures_, uv_);
      p.exact = {.base = base_of(l.type),
                 .nonlinear = l.nonlinear,
                 .sigma = l.sigma,
                 .roughness = roughness(l),
                 .ior = l.ior,
                 .eta = l.eta,
                 .k = l.k,
                 .reflectance = reflectance(l),
                 .transmittance = l.transmittance};
    }
    if (l.one_sided) p.exact->one_sided = true;
    return p;
  }

 private:
  static SurfaceParams black() {
    SurfaceParams p;
    p.base_color = Rgb(0, 0, 0);
    p.exact = {.base = Base::diffuse};
    return p;
  }
  Rgba texel(const TextureRef& ref) const {
    return ref.used() ? texture_at(ref, textures_, uv_) : Rgba{};
  }
  Roughness roughness(const LacunaMaterial& l) const {
    return {l.alpha * texel(l.alpha_texture).rgb.x, l.shape};
  }
  Rgb reflectance(const LacunaMaterial& l) const {
    return l.reflectance * texel(l.reflectance_texture).rgb;
  }

  ChosenPart choose(const LacunaMaterial& l) {
    const bool textured = l.weight_texture.used();
    const float w = texel(l.weight_texture).rgb.x;
    // The largest channels are the probabilities. They may have a sum above 1 where the parts have
    // different colours.
    const auto weight = [&](std::size_t i) {
      const float share = !textured ? 1 : i == 0 ? 1 - w : w;
      return share * l.parts[i].weight;
    };
    float sum = 0;
    for (std::size_t i = 0; i < l.parts.size(); ++i) sum += max_component(weight(i));
    float rest = std::max(1.0F, sum);
    const float total = rest;
    for (std::size_t i = 0; i < l.parts.size(); ++i) {
      const float share = max_component(weight(i));
      if (share > 0 && decide(share / rest)) {
        return {l.parts[i].material.get(), weight(i) * (total / share)};
      }
      rest -= share;
    }
    return {};
  }
  /// Each decision by other bits.
  bool decide(float probability) {
    std::array<std::uint32_t, 6> bits;
    std::copy(point_.begin(), point_.end(), bits.begin());
    bits.back() = decisions_++;
    return decide_by_bits(probability, bits);
  }

  Textures textures_;
  const std::array<V2f, 2>& uv_;
  PointBits point_;
  std::uint32_t decisions_ = 0;
};

}  // namespace

SurfaceParams lacuna_params(const Material& material, Textures textures,
                            const std::array<V2f, 2>& uv, const PointBits& point) {
  SurfaceParams p = PointParams(textures, uv, point).of(material);
  p.medium = material.medium();
  return p;
}

}  // namespace lacuna
