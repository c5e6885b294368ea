#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "jobs/import/pbrt/pbrt_colours.h"
#include "jobs/import/pbrt/pbrt_facets.h"
#include "jobs/import/pbrt/pbrt_materials.h"
#include "jobs/import/pbrt/pbrt_textures.h"

namespace lacuna::pbrt {
namespace {

struct V4Material {
  Context& context;
  const Parameters& p;

  void approximated(const std::string& how) const {
    context.approximated(p.place(), p.owner(), how);
  }
};

ImportedMaterial diffuse(const V4Material& s) {
  ImportedMaterial m;
  m.diffuse = colour_value(s.context, s.p, "reflectance", 0.5F);
  return m;
}

/// A smooth interface lets (1 - Fext) in, and the layer's inner side returns Fint of what the base
/// scatters; with n = 1.5, .092 and .596. The layer itself is a vacuum for pbrt-v4, but dims light
/// by exp(-thickness / cos) on each crossing.
ImportedMaterial coated_diffuse(const V4Material& s) {
  ImportedMaterial m = diffuse(s);
  m.type = ImportedMaterial::Type::plastic;
  m.nonlinear = true;
  m.ior = interface_index(s.context, s.p, "eta", 1.5);
  set_facets(m, read_facets(s.context, s.p, 0));
  const auto layer = float_value(s.context, s.p, "thickness");
  const double thickness = layer ? double(layer->value.x) : 0.01;
  // A crossing from outside runs at cos(refracted) of at least .745, on average .87.
  const float dimming = static_cast<float>(std::exp(-2 * thickness / 0.87));
  m.diffuse.value *= dimming;
  s.approximated(
      fmt::format("pbrt's random walk between coat and base becomes a closed form; the "
                  "thickness dims the base by {:.3f}",
                  dimming));
  s.p.ignore({"maxdepth", "nsamples", "g"});
  const auto albedo = colour_value(s.context, s.p, "albedo");
  if (albedo && !is_black(albedo->value)) s.approximated("the layer's own scattering is left out");
  return m;
}

/// eta and k, or the index of a given reflectance R at normal incidence: eta = 1,
/// k = 2 sqrt(R / (1 - R)).
ImportedMaterial conductor(const V4Material& s, const std::string& prefix) {
  const auto key = [&](const char* name) { return prefix + name; };
  const auto reflectance = colour_value(s.context, s.p, key("reflectance").c_str());
  if (reflectance && reflectance->texture != nullptr) {
    s.approximated("a texture of reflectance applies at all angles alike");
    return perfect_mirror(*reflectance);
  }
  ImportedMaterial m;
  m.type = ImportedMaterial::Type::conductor;
  if (!reflectance) {
    const auto is_texture = [&](const char* name) {
      return s.p.find(key(name), {"texture"}) != nullptr;
    };
    if (is_texture("eta") || is_texture("k")) {
      s.approximated("textures of eta and k are replaced by copper's");
    }
    m.eta = conductor_index(s.context, s.p, key("eta").c_str(), false);
    m.k = conductor_index(s.context, s.p, key("k").c_str(), true);
    return m;
  }
  m.eta = Rgb(1, 1, 1);
  for (int c = 0; c < 3; ++c) {
    const float r = std::clamp(reflectance->value[c], 0.0F, 0.9999F);
    m.k[c] = 2 * std::sqrt(r / (1 - r));
  }
  return m;
}

ImportedMaterial coated_conductor(const V4Material& s) {
  ImportedMaterial base = conductor(s, "conductor.");
  set_facets(base, read_facets(s.context, s.p, 0, "conductor."));
  ImportedMaterial m;
  m.type = ImportedMaterial::Type::coating;
  m.ior = interface_index(s.context, s.p, "interface.eta", 1.5);
  set_facets(m, read_facets(s.context, s.p, 0, "interface."));
  base.eta /= static_cast<float>(m.ior);  // relative to the coat
  base.k /= static_cast<float>(m.ior);
  const auto layer = float_value(s.context, s.p, "thickness");
  m.thickness = layer ? double(layer->value.x) : 0.01;
  m.absorption = Rgb(1, 1, 1);  // pbrt-v4's layers dim by exp(-thickness / cos)
  m.parts = {{std::make_shared<ImportedMaterial>(base), Rgb(1, 1, 1)}};
  s.approximated("reflections between coat and metal are left out");
  s.p.ignore({"maxdepth", "nsamples", "g"});
  const auto albedo = colour_value(s.context, s.p, "albedo");
  if (albedo && !is_black(albedo->value)) s.approximated("the layer's own scattering is left out");
  return m;
}

ImportedMaterial diffuse_transmission(const V4Material& s) {
  ImportedValue r = colour_value(s.context, s.p, "reflectance", 0.25F);
  ImportedValue t = colour_value(s.context, s.p, "transmittance", 0.25F);
  const float scale = static_cast<float>(s.p.number("scale", 1));
  r.value *= scale;
  t.value *= scale;
  return diffuse_both_sides(s.context, s.p, r, t);
}

}  // namespace

std::optional<ImportedMaterial> make_v4_material(Context& context, const std::string& type,
                                                 const Parameters& parameters) {
  const V4Material s{context, parameters};
  if (type == "diffuse") return diffuse(s);
  if (type == "coateddiffuse") return coated_diffuse(s);
  if (type == "coatedconductor") return coated_conductor(s);
  if (type == "diffusetransmission") return diffuse_transmission(s);
  if (type == "conductor") {
    ImportedMaterial m = conductor(s, "");
    set_facets(m, read_facets(context, parameters, 0));
    return m;
  }
  if (type == "dielectric" || type == "thindielectric") {
    ImportedMaterial m;
    m.type = type == "dielectric" ? ImportedMaterial::Type::dielectric
                                  : ImportedMaterial::Type::thin_dielectric;
    m.ior = interface_index(context, parameters, "eta", 1.5);
    if (type == "dielectric") set_facets(m, read_facets(context, parameters, 0));
    return m;
  }
  if (type == "measured" || type == "hair") {
    s.approximated("a diffuse material of reflectance 0.5 stands for it");
    for (const Parameter& p : parameters.all()) p.used = true;
    return ImportedMaterial{};
  }
  return {};
}

}  // namespace lacuna::pbrt
