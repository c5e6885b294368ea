#include "jobs/import/standard_material.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "jobs/import/glb_document.h"

namespace lacuna {
namespace {

/// glTF's roughness is the square root of alpha.
double roughness_of(const std::array<double, 2>& alpha) {
  return std::sqrt(std::clamp(std::sqrt(alpha[0] * alpha[1]), 0.0, 1.0));
}

/// Reflectance at normal incidence for eta + i k.
float normal_reflectance(float eta, float k) {
  return ((eta - 1) * (eta - 1) + k * k) / ((eta + 1) * (eta + 1) + k * k);
}

void set_facets(const ImportedMaterial& m, StandardMaterial& s) {
  s.roughness = roughness_of(m.alpha);
  const double u = m.alpha[0], v = m.alpha[1];
  if (u == v) return;
  // KHR_materials_anisotropy widens one axis: alpha_t = mix(alpha, 1, strength^2).
  s.roughness = std::sqrt(std::clamp(std::min(u, v), 0.0, 1.0));
  s.anisotropy =
      std::sqrt(std::clamp((std::max(u, v) - std::min(u, v)) / (1 - std::min(u, v)), 0.0, 1.0));
  if (v > u) s.anisotropy_rotation = std::numbers::pi / 2;
}

void set_conductor(const ImportedMaterial& m, StandardMaterial& s) {
  s.metallic = 1;
  s.base_color = m.reflectance;
  for (int c = 0; c < 3; ++c) s.base_color.value[c] *= normal_reflectance(m.eta[c], m.k[c]);
  set_facets(m, s);
}

/// The part that other viewers see of a mixture: the one of the largest weight.
const ImportedMaterial& main_part(const ImportedMaterial& m) {
  return *std::max_element(m.parts.begin(), m.parts.end(), [](const auto& a, const auto& b) {
            return luminance(a.weight) < luminance(b.weight);
          })->material;
}

void set_own(const ImportedMaterial& m, StandardMaterial& s) {
  s.base_color = m.diffuse;
  s.metallic = m.metallic;
  s.roughness = m.roughness;
  s.ior = std::max(1.0, m.ior);
  s.specular = std::clamp(m.specular, 0.0, 1.0);
  s.transmission = m.transmission;
  s.coat = m.coat;
  s.coat_roughness = m.coat_roughness;
  s.sheen = m.sheen;
  s.anisotropy = m.anisotropy;
  s.solid = m.transmission > 0 && !m.thin;
}

}  // namespace

bool is_smooth(const ImportedMaterial& m) {
  return m.alpha == std::array<double, 2>{0, 0} && !m.alpha_texture;
}

StandardMaterial standard_material(const ImportedMaterial& m) {
  StandardMaterial s;
  s.base_color = m.diffuse;
  switch (m.type) {
    case ImportedMaterial::Type::diffuse:
      s.specular = 0;
      break;
    case ImportedMaterial::Type::black:
      s.base_color = {{0, 0, 0}, nullptr};
      s.specular = 0;
      break;
    case ImportedMaterial::Type::diffuse_transmission:
      s.base_color = {{0, 0, 0}, nullptr};
      s.specular = 0;
      s.transmits_diffusely = true;
      s.transmitted = m.transmittance;
      break;
    case ImportedMaterial::Type::conductor:
      set_conductor(m, s);
      break;
    case ImportedMaterial::Type::dielectric:
    case ImportedMaterial::Type::thin_dielectric:
      s.base_color = m.transmittance;
      s.transmission = 1;
      s.solid = m.type == ImportedMaterial::Type::dielectric;
      s.absorption = m.absorption;
      s.ior = std::max(1.0, m.ior);
      set_facets(m, s);
      break;
    case ImportedMaterial::Type::plastic:
      s.ior = std::max(1.0, m.ior);
      set_facets(m, s);
      break;
    case ImportedMaterial::Type::phong:
      s.specular_color = m.reflectance.value;
      s.roughness = std::sqrt(std::sqrt(2 / (m.exponent + 2)));  // Walter 2007, sec. 5.2
      break;
    case ImportedMaterial::Type::ward:
      s.specular_color = m.reflectance.value;
      set_facets(m, s);
      break;
    case ImportedMaterial::Type::coating:
      s = standard_material(*m.parts.at(0).material);
      s.coat = 1;
      s.coat_roughness = roughness_of(m.alpha);
      break;
    case ImportedMaterial::Type::mixture:
      s = standard_material(main_part(m));
      break;
    case ImportedMaterial::Type::standard:
      set_own(m, s);
      break;
  }
  return s;
}

OrderedJson StandardMaterial::extensions() const {
  OrderedJson out = OrderedJson::object();
  if (ior != 1.5) out["KHR_materials_ior"] = {{"ior", ior}};
  if (specular != 1 || specular_color != Rgb(1, 1, 1)) {
    out["KHR_materials_specular"] = {{"specularFactor", specular}};
    if (specular_color != Rgb(1, 1, 1)) {
      out["KHR_materials_specular"]["specularColorFactor"] = gltf_color(specular_color);
    }
  }
  if (transmission > 0) out["KHR_materials_transmission"] = {{"transmissionFactor", transmission}};
  if (solid) {
    out["KHR_materials_volume"] = {{"thicknessFactor", 1}};
    if (absorption != Rgb(0, 0, 0)) {
      // sigma = -ln(attenuationColor) / attenuationDistance; at this distance no colour underflows.
      const float distance = 1 / max_component(absorption);
      Rgb left;
      for (int c = 0; c < 3; ++c) left[c] = std::exp(-absorption[c] * distance);
      out["KHR_materials_volume"]["attenuationDistance"] = distance;
      out["KHR_materials_volume"]["attenuationColor"] = gltf_color(left);
    }
  }
  if (coat > 0) {
    out["KHR_materials_clearcoat"] = {{"clearcoatFactor", coat},
                                      {"clearcoatRoughnessFactor", coat_roughness}};
  }
  if (sheen != Rgb(0, 0, 0)) {
    out["KHR_materials_sheen"] = {{"sheenColorFactor", gltf_color(sheen)},
                                  {"sheenRoughnessFactor", .5}};
  }
  if (anisotropy > 0) {
    out["KHR_materials_anisotropy"] = {{"anisotropyStrength", anisotropy},
                                       {"anisotropyRotation", anisotropy_rotation}};
  }
  if (transmits_diffusely) {
    out["KHR_materials_diffuse_transmission"] = {
        {"diffuseTransmissionFactor", 1},
        {"diffuseTransmissionColorFactor", gltf_color(transmitted.value)}};
  }
  return out;
}

}  // namespace lacuna
