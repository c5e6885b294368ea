#include "jobs/import/imported_materials.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "jobs/import/standard_material.h"

namespace lacuna {
namespace {

const char* name_of(ImportedMaterial::Type type) {
  switch (type) {
    case ImportedMaterial::Type::conductor:
      return "conductor";
    case ImportedMaterial::Type::dielectric:
      return "dielectric";
    case ImportedMaterial::Type::thin_dielectric:
      return "thinDielectric";
    case ImportedMaterial::Type::plastic:
      return "plastic";
    case ImportedMaterial::Type::phong:
      return "phong";
    case ImportedMaterial::Type::ward:
      return "ward";
    case ImportedMaterial::Type::coating:
      return "coating";
    case ImportedMaterial::Type::mixture:
      return "mixture";
    default:
      return "diffuse";
  }
}

/// Whether glTF's own terms are exact. Its smooth glass is: the exact Fresnel term, refraction.
bool is_exact_in_gltf(const ImportedMaterial& m) {
  const bool white = m.reflectance.value == Rgb(1, 1, 1) && m.transmittance.value == Rgb(1, 1, 1);
  if (m.bump_map) return false;
  switch (m.type) {
    case ImportedMaterial::Type::diffuse:
      return !m.one_sided && m.sigma == 0;
    case ImportedMaterial::Type::dielectric:
      return is_smooth(m) && white && m.ior >= 1;
    case ImportedMaterial::Type::diffuse_transmission:
    case ImportedMaterial::Type::standard:
      return true;
    case ImportedMaterial::Type::black:
      return true;
    default:
      return false;
  }
}

OrderedJson pair_of(const std::array<double, 2>& alpha) {
  if (alpha[0] == alpha[1]) return alpha[0];
  return {alpha[0], alpha[1]};
}

}  // namespace

std::size_t ImportedMaterials::index(const std::shared_ptr<const ImportedMaterial>& material,
                                     const std::optional<ImportedValue>& radiance,
                                     bool emits_behind) {
  const ImportedValue light = radiance.value_or(ImportedValue{{0, 0, 0}, nullptr});
  const Key key{material.get(), light.texture.get(), light.value.x,       light.value.y,
                light.value.z,  emits_behind,        radiance.has_value()};
  if (const auto found = indices_.find(key); found != indices_.end()) return found->second;
  OrderedJson json = json_of(*material);
  if (radiance) add_emission(*radiance, json);
  // Elsewhere it says nothing to Lacuna; other viewers hide the back of what is single-sided.
  const bool solid = material->type == ImportedMaterial::Type::dielectric;
  if (emits_behind || (!radiance && !material->one_sided && !solid)) json["doubleSided"] = true;
  kept_.push_back(material);
  return indices_[key] = document_.add("materials", std::move(json));
}

OrderedJson ImportedMaterials::json_of(const ImportedMaterial& m) {
  OrderedJson json;
  if (!m.name.empty()) json["name"] = m.name;
  add_standard(m, json);
  if (m.normal_map) json["normalTexture"] = textures_.vectors(*m.normal_map);
  if (!is_exact_in_gltf(m)) add_exact(m, json);
  return json;
}

Rgb ImportedMaterials::within_one(const ImportedMaterial& m, const Rgb& color,
                                  const std::string& what) {
  Rgb out = color;
  for (int c = 0; c < 3; ++c) out[c] = std::clamp(out[c], 0.0F, 1.0F);
  constexpr float rounding = 1e-5F;  // of colours that files give with six digits
  if ((out - color).length() > rounding) {
    notes_.push_back({m.place, m.name, "approximated",
                      fmt::format("{} ({:.4g} {:.4g} {:.4g}) is clamped to 0 to 1", what, color.x,
                                  color.y, color.z)});
  }
  return out;
}

void ImportedMaterials::add_base(const ImportedMaterial& m, const ImportedValue& color,
                                 OrderedJson& json) {
  OrderedJson& pbr = json["pbrMetallicRoughness"];
  const Rgb base = within_one(m, color.value, "its reflectance");
  const float alpha = std::clamp(luminance(m.opacity.value), 0.0F, 1.0F);
  pbr["baseColorFactor"] = {base.x, base.y, base.z, alpha};
  const bool blended = alpha < 1 || m.opacity.texture;
  if (m.opacity.texture || (blended && color.texture)) {
    pbr["baseColorTexture"] = textures_.color_with_alpha(color.texture.get(), m.opacity);
  } else if (color.texture) {
    pbr["baseColorTexture"] = textures_.color(*color.texture);
  }
  if (blended) json["alphaMode"] = "BLEND";
}

void ImportedMaterials::add_standard(const ImportedMaterial& m, OrderedJson& json) {
  StandardMaterial s = standard_material(m);
  s.transmitted.value = within_one(m, s.transmitted.value, "its transmittance");
  add_base(m, s.base_color, json);
  OrderedJson& pbr = json["pbrMetallicRoughness"];
  pbr["metallicFactor"] = s.metallic;
  pbr["roughnessFactor"] = s.roughness;
  if (m.type == ImportedMaterial::Type::standard && (m.roughness_texture || m.metallic_texture)) {
    pbr["metallicRoughnessTexture"] =
        textures_.metallic_roughness(m.metallic_texture.get(), m.roughness_texture.get());
  }
  OrderedJson extensions = s.extensions();
  if (s.transmits_diffusely && s.transmitted.texture) {
    extensions["KHR_materials_diffuse_transmission"]["diffuseTransmissionColorTexture"] =
        textures_.color(*s.transmitted.texture);
  }
  if (!extensions.empty()) json["extensions"] = std::move(extensions);
}

void ImportedMaterials::add_emission(const ImportedValue& radiance, OrderedJson& json) {
  double scale = 1;
  if (radiance.texture) json["emissiveTexture"] = textures_.color(*radiance.texture, &scale);
  const Rgb total = radiance.value * static_cast<float>(scale);
  const float strength = std::max(1.0F, max_component(total));
  json["emissiveFactor"] = gltf_color(total / strength);
  if (strength > 1) {
    json["extensions"]["KHR_materials_emissive_strength"] = {{"emissiveStrength", strength}};
  }
}

void ImportedMaterials::add_facets(const ImportedMaterial& m, OrderedJson& exact) {
  if (m.beckmann) exact["distribution"] = "beckmann";
  if (m.correlated_masking && !is_smooth(m)) exact["masking"] = "correlated";
  if (!is_smooth(m)) exact["alpha"] = pair_of(m.alpha);
  if (m.alpha_texture) exact["alphaTexture"] = textures_.number(*m.alpha_texture);
}

void ImportedMaterials::add_reflectance(const ImportedMaterial& m, OrderedJson& exact) {
  if (m.reflectance.value != Rgb(1, 1, 1) || m.type == ImportedMaterial::Type::phong ||
      m.type == ImportedMaterial::Type::ward) {
    exact["reflectance"] =
        gltf_color(within_one(m, m.reflectance.value, "its specular reflectance"));
  }
  if (!m.reflectance.texture) return;
  if (m.type == ImportedMaterial::Type::conductor || m.type == ImportedMaterial::Type::phong ||
      m.type == ImportedMaterial::Type::ward) {
    exact["reflectanceTexture"] = textures_.color(*m.reflectance.texture);
  } else {
    notes_.push_back({m.place, m.name, "left out",
                      "the texture of its specular reflectance, which is read of conductors, "
                      "phong and ward only"});
  }
}

void ImportedMaterials::add_parts(const ImportedMaterial& m, OrderedJson& exact) {
  if (m.type == ImportedMaterial::Type::coating) {
    exact["base"] = index(m.parts.at(0).material);
    exact["thickness"] = m.thickness;
    if (m.absorption != Rgb(0, 0, 0)) exact["absorption"] = gltf_color(m.absorption);
    return;
  }
  exact["parts"] = OrderedJson::array();
  for (const auto& part : m.parts) {
    OrderedJson weight = gltf_color(part.weight);
    if (part.weight.x == part.weight.y && part.weight.y == part.weight.z) weight = part.weight.x;
    exact["parts"].push_back({{"material", index(part.material)}, {"weight", std::move(weight)}});
  }
  if (m.weight_texture) exact["weightTexture"] = textures_.number(*m.weight_texture);
}

void ImportedMaterials::add_exact(const ImportedMaterial& m, OrderedJson& json) {
  OrderedJson exact = {{"type", name_of(m.type)}};
  const bool refracts = m.type == ImportedMaterial::Type::dielectric ||
                        m.type == ImportedMaterial::Type::thin_dielectric;
  if (m.one_sided && !refracts) exact["oneSided"] = true;
  if (m.bump_map) {
    exact["bump"] = textures_.number(*m.bump_map);
    exact["bump"]["scale"] = m.bump_scale;
  }
  if (m.type == ImportedMaterial::Type::diffuse && m.sigma != 0) exact["sigma"] = m.sigma;
  if (m.type == ImportedMaterial::Type::conductor) {
    exact["eta"] = gltf_color(m.eta);
    exact["k"] = gltf_color(m.k);
  }
  if (refracts || m.type == ImportedMaterial::Type::plastic ||
      m.type == ImportedMaterial::Type::coating)
    exact["ior"] = m.ior;
  if (m.type == ImportedMaterial::Type::conductor || m.type == ImportedMaterial::Type::dielectric ||
      m.type == ImportedMaterial::Type::plastic || m.type == ImportedMaterial::Type::coating) {
    add_facets(m, exact);
  }
  if (m.type != ImportedMaterial::Type::diffuse && m.type != ImportedMaterial::Type::mixture)
    add_reflectance(m, exact);
  if (refracts && m.transmittance.value != Rgb(1, 1, 1)) {
    exact["transmittance"] =
        gltf_color(within_one(m, m.transmittance.value, "its specular transmittance"));
  }
  if (m.type == ImportedMaterial::Type::plastic && m.nonlinear) exact["nonlinear"] = true;
  if (m.type == ImportedMaterial::Type::phong) exact["exponent"] = m.exponent;
  if (m.type == ImportedMaterial::Type::ward) {
    exact["alpha"] = pair_of(m.alpha);
    exact["variant"] = m.ward_variant;
  }
  if (m.type == ImportedMaterial::Type::coating || m.type == ImportedMaterial::Type::mixture)
    add_parts(m, exact);
  json["extensions"]["LACUNA_materials"] = std::move(exact);
}

}  // namespace lacuna
