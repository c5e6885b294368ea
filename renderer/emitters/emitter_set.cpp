#include "renderer/emitters/emitter_set.h"

#include <numbers>

#include "renderer/core/sampling.h"
#include "renderer/geometry/surface.h"
#include "renderer/materials/gltf_material.h"

namespace lacuna {

namespace {

/// Luminous power, for a directional light an estimate. It determines only the emitter's selection
/// probability.
double power(const PunctualLight& light, double scene_radius) {
  const double i = luminance(light.intensity);
  switch (light.kind) {
    case PunctualLight::Kind::point:
      return i * 4 * std::numbers::pi;
    case PunctualLight::Kind::spot:
      return i * SpotCones::power(light.inner_cone, light.outer_cone);
    case PunctualLight::Kind::directional:
      return i * std::numbers::pi * scene_radius * scene_radius;
  }
  return 0;
}

}  // namespace

EmitterSet::EmitterSet(const SceneData& scene, std::unique_ptr<Environment> environment,
                       const Bounds& bounds, bool pointwise)
    : scene_(&scene),
      bounds_(bounds),
      environment_(std::move(environment)),
      first_entry_(scene.meshes.size(), none) {
  const double radius = bounds.radius();
  std::vector<double> powers;
  MeansOfTextures means;
  for (std::uint32_t m = 0; m < scene.meshes.size(); ++m) add_mesh(m, means, powers);
  for (std::uint32_t l = 0; l < scene.lights.size(); ++l) {
    Source source{Source::Kind::punctual};
    source.index = l;
    add_light(source, power(scene.lights[l], radius), powers);
  }
  if (environment_ != nullptr && !environment_->black()) {
    environment_entry_ = static_cast<std::uint32_t>(entries_.size());
    const double disk = std::numbers::pi * radius * radius;
    add_light({Source::Kind::environment}, environment_->integral() * disk, powers);
  }
  selection_ = AliasTable(selection_weights(powers));
  if (selection_.empty()) return;
  for (std::uint32_t i = 0; i < entries_.size(); ++i) {
    entries_[i].pdf = selection_.pmf(i) * entries_[i].pdf;
  }
  if (pointwise) select_pointwise(powers);
}

/// With selection by power alone, light paths would hardly ever start in a room with lamps decades
/// dimmer than those of another. Part of all selections is therefore uniform over sources, meshes
/// and lights, and by power within each: a defensive mixture (Hesterberg 1995, "Weighted Average
/// Importance Sampling and Defensive Mixture Distributions"). Every probability is at least 1 -
/// `share` times that by power, so no variance grows by more than 1 / (1 - share) = 8 / 7.
std::vector<double> EmitterSet::selection_weights(std::span<const double> powers) const {
  constexpr double share = 0.125;
  std::vector<double> of_sources(sources_.size());
  double all = 0;
  for (std::size_t i = 0; i < powers.size(); ++i) {
    of_sources[entries_[i].source] += powers[i];
    all += powers[i];
  }
  const auto shining =
      std::count_if(of_sources.begin(), of_sources.end(), [](double power) { return power > 0; });
  std::vector<double> weights(powers.begin(), powers.end());
  if (shining < 2) return weights;
  for (std::size_t i = 0; i < weights.size(); ++i) {
    if (!(powers[i] > 0)) continue;
    const double of_source = powers[i] / of_sources[entries_[i].source];
    weights[i] = (1 - share) * (powers[i] / all) + share * of_source / static_cast<double>(shining);
  }
  return weights;
}

void EmitterSet::select_pointwise(std::span<const double> powers) {
  std::vector<TreeEmitter> finite;
  std::vector<PointwiseSelection::Infinite> infinite;
  for (std::uint32_t i = 0; i < entries_.size(); ++i) {
    if (!(powers[i] > 0)) continue;
    const Source& source = sources_[entries_[i].source];
    const bool everywhere = source.kind == Source::Kind::environment ||
                            (source.kind == Source::Kind::punctual &&
                             scene_->lights[source.index].kind == PunctualLight::Kind::directional);
    if (everywhere) {
      infinite.push_back({i, powers[i]});
    } else {
      finite.push_back(tree_emitter(i, powers[i]));
    }
  }
  double all = 0;
  for (const double p : powers) all += p;
  pointwise_.emplace(finite, infinite, all, bounds_.radius(), selection_);
}

TreeEmitter EmitterSet::tree_emitter(std::uint32_t entry, double power) const {
  const Entry& e = entries_[entry];
  const Source& source = sources_[e.source];
  TreeEmitter t;
  t.entry = entry;
  if (source.kind == Source::Kind::mesh) {
    for (const V3f& corner : e.corners) t.bounds.box.add(corner);
    t.bounds.axes = {V3d(e.ng).normalized(), 0};
    t.bounds.reach = std::numbers::pi / 2;
    t.bounds.both_sides = source.both_sides;
    t.bounds.intensity = power / (std::numbers::pi * source.sides());
    return t;
  }
  const PunctualLight& light = scene_->lights[source.index];
  t.bounds.box.add(light.position);
  t.bounds.axes = light.kind == PunctualLight::Kind::spot
                      ? DirectionCone{V3d(light.direction).normalized(), double(light.outer_cone)}
                      : DirectionCone::everything();
  t.bounds.intensity = double(luminance(light.intensity));
  return t;
}

/// Mean luminance of the emission of a triangle; 0 only if it is black everywhere, so that no
/// emission is missed.
double EmitterSet::mean_luminance(const Mesh& mesh, std::uint32_t triangle,
                                  const TextureMeans& means) {
  const Material& material = scene_->materials[mesh.material];
  const TextureRef& texture = material.emission_texture;
  const std::vector<V2f>& uvs = mesh.uvs[static_cast<std::size_t>(texture.uv_set)];
  std::array<V2f, 3> corners;
  float largest = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const V2f uv = uvs.empty() ? V2f(0, 0) : uvs[mesh.triangles[triangle][k]];
    corners[k] = texture.transform(uv);
    for (unsigned i = 0; i < 2; ++i) {
      largest = std::max({largest, std::abs(uv[i]), std::abs(uv[i] * texture.scale[i]),
                          std::abs(texture.offset[i])});
    }
  }
  const TextureMeans::Mean mean = means.over(corners, largest);
  texels_read_ += static_cast<std::uint64_t>(mean.cells);
  const V3d radiance = mean.rgb * V3d(material.emission);
  return luminance(radiance.x, radiance.y, radiance.z);
}

double EmitterSet::mean_color(const Mesh& mesh, std::uint32_t triangle) {
  double sum = 0;
  for (const std::uint32_t v : mesh.triangles[triangle]) {
    const V4f& c = mesh.colors[v];
    sum += double(luminance(c.x, c.y, c.z)) / 3;
  }
  return sum;
}

void EmitterSet::add_light(const Source& source, double power, std::vector<double>& powers) {
  Entry e;
  e.pdf = Pdf<Area>(1.0F);
  e.source = static_cast<std::uint32_t>(sources_.size());
  sources_.push_back(source);
  entries_.push_back(e);
  powers.push_back(power);
}

void EmitterSet::add_mesh(std::uint32_t m, MeansOfTextures& means, std::vector<double>& powers) {
  const Mesh& mesh = scene_->meshes[m];
  const Material& material = scene_->materials[mesh.material];
  if (!material.emits()) return;
  Source source{Source::Kind::mesh,
                material.emits_behind(),
                material.emission_texture.used(),
                material.emits_vertex_colors(),
                material.emission,
                m,
                static_cast<std::uint32_t>(entries_.size())};
  if (AlphaMask::needed(*scene_, mesh)) {
    source.mask = static_cast<std::uint32_t>(masks_.size());
    masks_.emplace_back(*scene_, mesh);
  }
  const TextureMeans* mean = nullptr;
  if (source.textured) {
    const int index = material.emission_texture.texture;
    const Texture& texture = *scene_->textures[static_cast<std::size_t>(index)];
    const auto [at, is_new] = means.try_emplace(index, texture);
    if (is_new) texels_read_ += texture.texels();
    mean = &at->second;
  }
  const auto uniform = double(luminance(material.emission));
  first_entry_[m] = source.first_entry;
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    Entry e{TriangleShape(mesh, t), {}, static_cast<std::uint32_t>(sources_.size())};
    const double area = e.area();
    e.pdf = Pdf<Area>(static_cast<float>(1 / area));
    entries_.push_back(e);
    double radiance = mean == nullptr ? uniform : mean_luminance(mesh, t, *mean);
    if (source.colored) radiance *= mean_color(mesh, t);
    powers.push_back(std::numbers::pi * source.sides() * radiance * area);
  }
  sources_.push_back(source);
}

EmitterPoint EmitterSet::sample_light(const Selected& selected) const {
  const std::uint32_t chosen = selected.entry;
  const Entry& e = entries_[chosen];
  const Source& source = sources_[e.source];
  EmitterPoint p = source.kind == Source::Kind::punctual
                       ? sample_punctual(scene_->lights[source.index])
                       : sample_environment(selected.at);
  p.entry = chosen;
  p.pdf = p.pdf.value * e.pdf;
  return p;
}

EmitterPoint EmitterSet::sample_environment(const Rng::FinePoint& at) const {
  const Environment::Sample d = environment_->sample(at);
  EmitterPoint p;
  p.kind = EmitterPoint::Kind::environment;
  p.x = d.w;
  p.emission = environment_->radiance(d.w);
  p.pdf = Pdf<Area>(d.pdf);
  p.across = across(d.w);
  return p;
}

Rgb EmitterSet::varying_emission(const Source& source, const Selected& chosen, const V2f& b) const {
  const std::uint32_t triangle = chosen.entry - source.first_entry;
  if (source.mask != none) {
    const std::array<std::uint32_t, 5> event{static_cast<std::uint32_t>(chosen.at.x),
                                             static_cast<std::uint32_t>(chosen.at.x >> 32),
                                             chosen.at.y, chosen.at.u_select, chosen.entry};
    if (!decide_by_bits(masks_[source.mask].coverage(triangle, b), event)) return Rgb(0, 0, 0);
  }
  if (!source.textured && !source.colored) return source.emission;
  const Mesh& mesh = scene_->meshes[source.index];
  const Rgb emitted = lacuna::emission(scene_->materials[mesh.material], scene_->textures,
                                       mesh.uvs_at(triangle, b.x, b.y));
  if (!source.colored) return emitted;
  const V4f color = mesh.mix(mesh.colors, triangle, b);
  return emitted * Rgb(color.x, color.y, color.z);
}

EmitterPoint EmitterSet::sample_punctual(const PunctualLight& light) const {
  EmitterPoint p;
  p.pdf = Pdf<Area>(1.0F);
  p.emission = light.intensity;
  if (light.kind == PunctualLight::Kind::directional) {
    p.kind = EmitterPoint::Kind::directional;
    p.x = -light.direction;
    p.across = across(p.x);
    return p;
  }
  p.kind = EmitterPoint::Kind::point;
  p.x = light.position;
  p.contact = light.contact.get();
  if (light.kind == PunctualLight::Kind::spot) {
    p.kind = EmitterPoint::Kind::spot;
    p.ng = light.direction;
    p.cones = SpotCones(light.inner_cone, light.outer_cone);
  }
  return p;
}

std::string EmitterSet::name(std::uint32_t entry) const {
  const Source& source = sources_[entries_[entry].source];
  switch (source.kind) {
    case Source::Kind::mesh:
      return scene_->meshes[source.index].name;
    case Source::Kind::punctual:
      return scene_->lights[source.index].name;
    case Source::Kind::environment:
      return "environment";
  }
  return {};
}

EmitterPoint EmitterSet::hit(const Surface& s, const Rgb& radiance) const {
  EmitterPoint p;
  p.both_sides = s.emits_behind;
  p.offset = s.offset;
  p.x = s.x;
  p.ng = s.ng;
  p.emission = radiance;
  p.pdf = pdf(s.mesh, s.triangle);
  if (p.pdf.positive()) p.entry = first_entry_[s.mesh] + s.triangle;
  return p;
}

EmitterPoint EmitterSet::hit_background(const V3f& w) const {
  EmitterPoint p;
  p.kind = EmitterPoint::Kind::environment;
  p.x = w;
  if (environment_ == nullptr) return p;
  p.emission = environment_->radiance(w);
  if (environment_entry_ != none) {
    p.entry = environment_entry_;
    p.pdf = environment_->pdf(w) * entries_[environment_entry_].pdf;
  }
  p.across = across(w);
  return p;
}

Pdf<Area> EmitterSet::pdf(std::uint32_t mesh, std::uint32_t triangle) const {
  if (first_entry_[mesh] == none || selection_.empty()) return {};
  return entries_[first_entry_[mesh] + triangle].pdf;
}

Rgb EmitterSet::background(const V3f& w) const {
  return environment_ == nullptr ? Rgb(0, 0, 0) : environment_->radiance(w);
}

}  // namespace lacuna
