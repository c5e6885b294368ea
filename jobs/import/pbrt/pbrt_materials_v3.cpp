#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "jobs/import/pbrt/pbrt_colours.h"
#include "jobs/import/pbrt/pbrt_facets.h"
#include "jobs/import/pbrt/pbrt_materials.h"
#include "jobs/import/pbrt/pbrt_textures.h"

namespace lacuna::pbrt {
namespace {

struct V3Material {
  Context& context;
  const Parameters& p;

  ImportedValue colour(const char* name, float grey) const {
    return colour_value(context, p, name, grey);
  }
  /// A factor that must be uniform.
  double factor(const char* name, double otherwise) const {
    const auto value = float_value(context, p, name);
    if (!value) return otherwise;
    if (value->texture != nullptr) approximated(fmt::format("\"{}\" is 0.5 of its texture", name));
    return double(value->value.x) * (value->texture != nullptr ? 0.5 : 1);
  }
  double index() const {
    return interface_index(context, p, "eta", interface_index(context, p, "index", 1.5));
  }
  void approximated(const std::string& how) const {
    context.approximated(p.place(), p.owner(), how);
  }
};

/// The mean of Schlick's Fresnel term over the projected hemisphere.
double mean_schlick(double f0) { return f0 + (1 - f0) / 21; }

Rgb uniform(float x) { return {x, x, x}; }

ImportedMaterial matte(const V3Material& s) {
  ImportedMaterial m;
  m.diffuse = s.colour("Kd", 0.5F);
  const double degrees = s.factor("sigma", 0);
  if (degrees < 0) fail(s.p.place(), fmt::format("sigma {}; allowed: 0 and more", degrees));
  m.sigma = std::min(degrees, 90.0) * std::numbers::pi / 180;
  if (m.sigma > 0) s.approximated("Oren and Nayar's full form instead of their qualitative one");
  return m;
}

/// Lambert's lobe plus facets with the Fresnel reflectance of an interface, neither dimmed by the
/// other. In weights: w (Kd / w) + (1 - w) (Ks F / (1 - w)), which is exact if both colours are at
/// most 1: w is from max Kd to 1 - max Ks, where F asks for as much as there is. A conductor
/// without absorption has that Fresnel reflectance. Else glTF's own material, whose diffuse lobe
/// the Fresnel reflectance dims: brightened so that the mean stays.
ImportedMaterial diffuse_and_facets(const V3Material& s, const ImportedValue& kd,
                                    const ImportedValue& ks, const Facets& facets, double index) {
  ImportedMaterial m;
  m.diffuse = kd;
  const float d = max_component(kd.value), r = max_component(ks.value);
  if (!(r > 0)) return m;
  ImportedMaterial specular;
  specular.type = ImportedMaterial::Type::conductor;
  specular.eta = uniform(static_cast<float>(index));
  specular.reflectance = ks;
  set_facets(specular, facets);
  if (!(d > 0)) return specular;
  if (d + r <= 1) {
    const float w = 1 - r;
    m.diffuse.value /= w;
    specular.reflectance.value /= 1 - w;
    return mixture_of(m, uniform(w), specular, uniform(1 - w));
  }
  m.type = ImportedMaterial::Type::standard;
  m.ior = index;
  m.specular = std::min(double(luminance(ks.value)), 1.0);
  const double f0 = std::pow((index - 1) / (index + 1), 2);
  const auto undimmed = static_cast<float>(1 / (1 - m.specular * mean_schlick(f0)));
  for (int c = 0; c < 3; ++c) {
    m.diffuse.value[c] = std::min(kd.value[c] * undimmed, std::max(kd.value[c], 1.0F));
  }
  set_roughness(m, facets);
  s.approximated("glTF's own material: its diffuse lobe is dimmed by the specular one");
  return m;
}

ImportedMaterial plastic(const V3Material& s) {
  return diffuse_and_facets(s, s.colour("Kd", 0.25F), s.colour("Ks", 0.25F),
                            read_facets(s.context, s.p, 0.1), 1.5);
}

ImportedMaterial uber(const V3Material& s) {
  const double index = s.index();
  const Facets facets = read_facets(s.context, s.p, 0.1);
  ImportedValue ks = s.colour("Ks", 0.25F);
  const ImportedValue kr = s.colour("Kr", 0), kt = s.colour("Kt", 0);
  const ImportedValue kd = s.colour("Kd", 0.25F);
  Facets used = facets;
  if (!is_black(kr.value)) {
    if (is_black(ks.value)) {
      ks = kr;
      used = Facets{};
    } else {
      s.approximated("Kr is left out beside Ks");
    }
  }
  ImportedMaterial m = diffuse_and_facets(s, kd, ks, used, index);
  if (!is_black(kt.value)) {
    ImportedMaterial glass;
    glass.type = ImportedMaterial::Type::dielectric;
    glass.ior = index;
    glass.reflectance.value = uniform(0);
    glass.transmittance = kt;
    const float w = std::min(max_component(kt.value), 1.0F);
    if (is_black(kd.value) && is_black(ks.value)) {
      m = glass;
    } else {
      s.approximated("of Kt and the other lobes each hit takes one, which dims both");
      m = mixture_of(m, uniform(1 - w / 2), glass, uniform(w / 2));
    }
  }
  if (const auto opacity = colour_value(s.context, s.p, "opacity")) m.opacity = *opacity;
  const Rgb& o = m.opacity.value;
  if (o.x != o.y || o.y != o.z) s.approximated("opacity is that of red");
  return m;
}

/// Ashikhmin and Shirley's coat: like glTF's own material of F0 = Ks, with the mean albedo of their
/// diffuse lobe, 23 / 28 (1 - Ks) Kd, instead of one minus that of Schlick's term.
ImportedMaterial substrate(const V3Material& s) {
  ImportedMaterial m;
  m.type = ImportedMaterial::Type::standard;
  m.diffuse = s.colour("Kd", 0.5F);
  const ImportedValue ks = s.colour("Ks", 0.5F);
  const double f0 = std::clamp(double(luminance(ks.value)) * (ks.texture ? 0.5 : 1), 0.0, 0.9);
  m.ior = (1 + std::sqrt(f0)) / (1 - std::sqrt(f0));
  m.diffuse.value *= static_cast<float>(23.0 / 28 * (1 - f0) / (1 - mean_schlick(f0)));
  set_roughness(m, read_facets(s.context, s.p, 0.1));
  s.approximated("glTF's own material of the same mean albedo");
  return m;
}

ImportedMaterial metal(const V3Material& s) {
  ImportedMaterial m;
  m.type = ImportedMaterial::Type::conductor;
  m.eta = conductor_index(s.context, s.p, "eta", false);
  m.k = conductor_index(s.context, s.p, "k", true);
  set_facets(m, read_facets(s.context, s.p, 0.01));
  return m;
}

ImportedMaterial glass(const V3Material& s) {
  ImportedMaterial m;
  m.type = ImportedMaterial::Type::dielectric;
  m.ior = s.index();
  m.reflectance = s.colour("Kr", 1);
  m.transmittance = s.colour("Kt", 1);
  Facets facets = read_facets(s.context, s.p, 0);
  // Without roughness the surface is smooth, whatever `remaproughness` would make of 0.
  const auto is_zero = [&](const char* name) {
    const auto value = float_value(s.context, s.p, name);
    return !value || (value->texture == nullptr && value->value.x == 0);
  };
  if (is_zero("uroughness") && is_zero("vroughness") && is_zero("roughness")) facets = Facets{};
  set_facets(m, facets);
  return m;
}

ImportedMaterial translucent(const V3Material& s) {
  const ImportedValue reflect = s.colour("reflect", 0.5F), transmit = s.colour("transmit", 0.5F);
  const ImportedValue kd = s.colour("Kd", 0.25F), ks = s.colour("Ks", 0.25F);
  s.p.ignore({"roughness", "remaproughness"});
  if (!is_black(ks.value)) s.approximated("the facets of Ks are left out");
  if (reflect.texture || transmit.texture)
    s.approximated("textures of reflect, transmit are left out");
  return diffuse_both_sides(s.context, s.p, {kd.value * reflect.value, kd.texture},
                            {kd.value * transmit.value, kd.texture});
}

ImportedMaterial disney(const V3Material& s) {
  ImportedMaterial m;
  m.type = ImportedMaterial::Type::standard;
  m.diffuse = s.colour("color", 0.5F);
  m.metallic = std::clamp(s.factor("metallic", 0), 0.0, 1.0);
  m.roughness = std::clamp(s.factor("roughness", 0.5), 0.0, 1.0);
  m.ior = s.factor("eta", 1.5);
  m.transmission = std::clamp(s.factor("spectrans", 0), 0.0, 1.0);
  m.coat = std::clamp(s.factor("clearcoat", 0), 0.0, 1.0) / 4;  // Burley 2012: a quarter of it
  // Burley 2012: alpha from .1 to .001, glTF's is the square of its roughness.
  const double gloss = std::clamp(s.factor("clearcoatgloss", 1), 0.0, 1.0);
  m.coat_roughness = std::sqrt(0.1 + (0.001 - 0.1) * gloss);
  m.anisotropy = std::clamp(s.factor("anisotropic", 0), 0.0, 1.0);
  const double sheen = s.factor("sheen", 0), tint = s.factor("sheentint", 0.5);
  const float y = luminance(m.diffuse.value);
  const Rgb hue = y > 0 ? m.diffuse.value / y : Rgb(1, 1, 1);
  m.sheen = (Rgb(1, 1, 1) * static_cast<float>(1 - tint) + hue * static_cast<float>(tint)) *
            static_cast<float>(std::clamp(sheen, 0.0, 1.0));
  s.approximated("glTF's own material with the nearest parameters");
  return m;
}

/// Light that scatters below the surface comes out where it went in.
ImportedMaterial subsurface(const V3Material& s) {
  ImportedMaterial m;
  m.type = ImportedMaterial::Type::plastic;
  m.nonlinear = true;
  const bool kd = s.p.find("Kd", {"rgb", "spectrum", "xyz", "texture"}) != nullptr;
  m.diffuse = s.colour(kd ? "Kd" : "reflectance", 0.5F);
  m.ior = interface_index(s.context, s.p, "eta", 1.33);
  set_facets(m, read_facets(s.context, s.p, 0));
  for (const Parameter& p : s.p.all()) p.used = true;
  s.approximated("a plastic stands for scattering below the surface");
  return m;
}

}  // namespace

std::optional<ImportedMaterial> make_v3_material(Context& context, const std::string& type,
                                                 const Parameters& parameters) {
  const V3Material s{context, parameters};
  if (type == "matte") return matte(s);
  if (type == "plastic") return plastic(s);
  if (type == "uber") return uber(s);
  if (type == "substrate") return substrate(s);
  if (type == "metal") return metal(s);
  if (type == "mirror") return perfect_mirror(s.colour("Kr", 0.9F));
  if (type == "glass") return glass(s);
  if (type == "translucent") return translucent(s);
  if (type == "disney") return disney(s);
  if (type == "subsurface" || type == "kdsubsurface") return subsurface(s);
  if (type == "fourier") {
    s.approximated("a diffuse material of reflectance 0.5 stands for it");
    for (const Parameter& p : parameters.all()) p.used = true;
    return ImportedMaterial{};
  }
  return {};
}

}  // namespace lacuna::pbrt
