#include "jobs/import/pbrt/pbrt_facets.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "jobs/import/pbrt/pbrt_textures.h"

namespace lacuna::pbrt {
namespace {

/// pbrt-v3's TrowbridgeReitzDistribution::RoughnessToAlpha.
double alpha_of_v3(double roughness) {
  const double x = std::log(std::max(roughness, 1e-3));
  return 1.62142 + x * (0.819955 + x * (0.1734 + x * (0.0171201 + x * 0.000640711)));
}

/// Of a picture of roughness, one whose value to the power `p` is stored instead.
std::shared_ptr<const ImportedTexture> to_power(const ImportedTexture& texture, double p) {
  const auto out = std::make_shared<ImportedTexture>(texture);
  // sRGB's curve is close to a power of 2.2.
  out->gamma = (texture.srgb ? 2.2 : texture.gamma) * p;
  out->srgb = false;
  return out;
}

struct Roughness {
  ImportedValue value;
  bool given = false;
};

Roughness find_roughness(const Context& context, const Parameters& p, const std::string& prefix,
                         const char* name, double otherwise) {
  auto value = float_value(context, p, (prefix + name).c_str());
  if (!value) value = float_value(context, p, (prefix + "roughness").c_str());
  const float x = static_cast<float>(otherwise);
  return {value.value_or(ImportedValue{Rgb(x, x, x), nullptr}), value.has_value()};
}

}  // namespace

Facets read_facets(Context& context, const Parameters& p, double otherwise,
                   const std::string& prefix) {
  const bool remap = p.boolean("remaproughness", true);
  const Roughness u = find_roughness(context, p, prefix, "uroughness", otherwise);
  const Roughness v = find_roughness(context, p, prefix, "vroughness", otherwise);
  const auto note = [&](const std::string& how) {
    context.approximated(p.place(), p.owner(), how);
  };
  if (u.value.texture != v.value.texture) {
    note("the texture of the roughness along u stands for both directions");
  }
  Facets out;
  out.texture = u.value.texture != nullptr ? u.value.texture : v.value.texture;
  const auto alpha = [&](double r) {
    if (!(r >= 0))
      fail(p.place(), fmt::format("{}: roughness {}; allowed: 0 and more", p.owner(), r));
    const double a = !remap ? r : context.is_v3() ? alpha_of_v3(r) : std::sqrt(r);
    if (a > 1) note(fmt::format("roughness {:.4g}, alpha {:.4g}: alpha is limited to 1", r, a));
    return std::min(a, 1.0);
  };
  out.alpha = {alpha(double(u.value.value.x)), alpha(double(v.value.value.x))};
  if (out.texture != nullptr && remap) {
    // pbrt-v3's polynomial lies between 1.62 r^.53 and 1.7 r^.56 from r = .01 to 1.
    const double power = context.is_v3() ? 0.54 : 0.5;
    if (context.is_v3() || out.texture->srgb) {
      note(fmt::format("a texture of roughness r becomes alpha = {} r^{}",
                       context.is_v3() ? "min(1, 1.62)" : "1", power));
    }
    out.texture = to_power(*out.texture, power);
  }
  return out;
}

void set_roughness(ImportedMaterial& material, const Facets& facets) {
  // glTF's roughness is the square root of alpha.
  material.roughness = std::sqrt((facets.alpha[0] + facets.alpha[1]) / 2);
  if (facets.texture != nullptr) material.roughness_texture = to_power(*facets.texture, 0.5);
}

void set_facets(ImportedMaterial& material, const Facets& facets) {
  material.correlated_masking = true;
  material.alpha = facets.alpha;
  material.alpha_texture = facets.texture;
}

}  // namespace lacuna::pbrt
