#include "renderer/emitters/emitter_set.h"

#include <numbers>

#include "renderer/core/sampling.h"
#include "renderer/materials/gltf_material.h"
#include "renderer/scene/surface.h"

namespace lacuna {

namespace {

/// W/sr of a spot in direction `cos_angle` off its axis (KHR_lights_punctual: squared ramp between
/// cones).
float spot_falloff(const PunctualLight& light, float cos_angle) {
  const float inner = std::cos(light.inner_cone);
  const float outer = std::cos(light.outer_cone);
  const float ramp = std::clamp((cos_angle - outer) / std::max(inner - outer, 1e-4F), 0.0F, 1.0F);
  return ramp * ramp;
}

/// Luminous power; an estimate where the light's profile is not constant. It decides how often the
/// emitter is chosen, not what it gives.
double power(const PunctualLight& light, double scene_radius) {
  const double i = luminance(light.intensity);
  switch (light.kind) {
    case PunctualLight::Kind::point:
      return i * 4 * std::numbers::pi;
    case PunctualLight::Kind::spot:
      return i * 2 * std::numbers::pi * (1 - std::cos(double(light.outer_cone)));
    case PunctualLight::Kind::directional:
      return i * std::numbers::pi * scene_radius * scene_radius;
  }
  return 0;
}

}  // namespace

EmitterSet::EmitterSet(const SceneData& scene, const TriangleTable& triangles,
                       std::unique_ptr<Environment> environment, float scene_radius)
    : scene_(&scene),
      triangles_(&triangles),
      environment_(std::move(environment)),
      first_entry_(scene.meshes.size(), none) {
  std::vector<double> powers;
  for (std::uint32_t m = 0; m < scene.meshes.size(); ++m) add_mesh(m, powers);
  for (std::uint32_t l = 0; l < scene.lights.size(); ++l) {
    entries_.push_back({Entry::Kind::punctual, l, 0, Pdf<Area>(1.0F), Rgb(0, 0, 0)});
    powers.push_back(power(scene.lights[l], scene_radius));
  }
  if (environment_ != nullptr && !environment_->black()) {
    environment_entry_ = static_cast<std::uint32_t>(entries_.size());
    entries_.push_back({Entry::Kind::environment, 0, 0, Pdf<Area>(1.0F), Rgb(0, 0, 0)});
    powers.push_back(environment_->integral() * std::numbers::pi * double(scene_radius) *
                     double(scene_radius));
  }
  selection_ = AliasTable(powers);
  if (selection_.empty()) return;
  for (std::uint32_t i = 0; i < entries_.size(); ++i) {
    entries_[i].pdf = selection_.pmf(i) * entries_[i].pdf;
  }
}

void EmitterSet::add_mesh(std::uint32_t m, std::vector<double>& powers) {
  const Mesh& mesh = scene_->meshes[m];
  const Material& material = scene_->materials[mesh.material];
  if (!material.emits()) return;
  double radiance = luminance(material.emission);
  if (material.emission_texture.used()) {
    const auto& texture =
        *scene_->textures[static_cast<std::size_t>(material.emission_texture.texture)];
    radiance = luminance(material.emission * texture.mean().rgb);
  }
  first_entry_[m] = static_cast<std::uint32_t>(entries_.size());
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    const float area = triangles_->at(m, t).area;
    entries_.push_back({Entry::Kind::triangle, m, t, Pdf<Area>(1 / area), material.emission});
    powers.push_back(radiance * double(area) * std::numbers::pi * (material.double_sided ? 2 : 1));
  }
}

EmitterSample EmitterSet::sample(const V3f& x, Rng& rng) const {
  const Entry& e = entries_[selection_.sample(rng)];
  switch (e.kind) {
    case Entry::Kind::triangle:
      return sample_triangle_of(e, x, rng.next2());
    case Entry::Kind::punctual: {
      EmitterSample s = sample_punctual(scene_->lights[e.mesh_or_light], x);
      s.pdf = e.pdf;
      return s;
    }
    case Entry::Kind::environment:
      break;
  }
  const Environment::Sample d = environment_->sample(rng);
  EmitterSample s;
  s.x = d.w;
  s.emission = environment_->radiance(d.w);
  s.pdf = d.pdf * e.pdf;
  s.infinite = true;
  return s;
}

EmitterSample EmitterSet::sample_triangle_of(const Entry& e, const V3f& x, const V2f& u) const {
  const TriangleRecord& t = triangles_->at(e.mesh_or_light, e.triangle);
  const V2f b = sample_triangle(u);
  EmitterSample s;
  s.x = t.at(b.x, b.y);
  s.ng = t.ng;
  s.extent = t.extent;
  s.pdf = e.pdf;
  s.emission = Rgb(0, 0, 0);
  if (!t.emits_behind && dot(x - s.x, s.ng) <= 0) return s;
  s.emission = e.emission;
  const Material& material = scene_->materials[t.material];
  if (t.textured && material.emission_texture.used()) {
    const Mesh& mesh = scene_->meshes[e.mesh_or_light];
    s.emission = emission(material, scene_->textures, mesh.uvs_at(e.triangle, b.x, b.y));
  }
  return s;
}

EmitterSample EmitterSet::sample_punctual(const PunctualLight& light, const V3f& x) {
  EmitterSample s;
  s.delta = true;
  s.emission = light.intensity;
  if (light.kind == PunctualLight::Kind::directional) {
    s.x = -light.direction;
    s.infinite = true;
    return s;
  }
  s.x = light.position;
  if (light.kind == PunctualLight::Kind::spot) {
    const V3f to_receiver = (x - light.position).normalized();
    s.emission *= spot_falloff(light, dot(to_receiver, light.direction));
  }
  return s;
}

Pdf<Area> EmitterSet::pdf(std::uint32_t mesh, std::uint32_t triangle) const {
  if (first_entry_[mesh] == none || selection_.empty()) return {};
  return entries_[first_entry_[mesh] + triangle].pdf;
}

Pdf<Area> EmitterSet::environment_pdf(const V3f& w) const {
  if (environment_entry_ == none) return {};
  return environment_->pdf(w) * entries_[environment_entry_].pdf;
}

Rgb EmitterSet::background(const V3f& w) const {
  return environment_ == nullptr ? Rgb(0, 0, 0) : environment_->radiance(w);
}

}  // namespace lacuna
