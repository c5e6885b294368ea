#include "renderer/scene/scene.h"

#include <algorithm>
#include <bit>
#include <set>
#include <string>
#include <vector>

#include "base/parallel/for_each_chunked.h"
#include "renderer/core/frame.h"
#include "renderer/core/scene_error.h"
#include "renderer/emitters/environment_cube.h"
#include "renderer/geometry/alpha_mask.h"
#include "renderer/geometry/surface_contact.h"
#include "renderer/geometry/tangent_frame.h"
#include "renderer/images/guards.h"
#include "renderer/images/image_read.h"
#include "renderer/materials/gltf_material.h"
#include "renderer/materials/lacuna_params.h"

namespace lacuna {

namespace {

/// Larger textures are decoded one at a time: decoding takes several times the memory of the
/// result.
constexpr std::uint64_t max_small_texels = std::uint64_t{1} << 24;

std::unique_ptr<Environment> load_environment(const EnvironmentImage& e) {
  FloatImage image = read_float_image(e.file);
  require_radiance(image, e.file.string());
  return std::make_unique<Environment>(image.width, image.height, std::move(image.rgb), e.scale,
                                       e.rotation);
}

/// What a mixture chooses its part by.
PointBits bits_of(const Surface& s) {
  const auto bits = [](float x) { return std::bit_cast<std::uint32_t>(x); };
  return {bits(s.x.x), bits(s.x.y), bits(s.x.z), s.mesh, s.triangle};
}

}  // namespace

Scene::Scene(SceneData data, const SceneNeeds& needs,
             const std::optional<EnvironmentImage>& environment, const ThreadPool& pool)
    : data_(std::make_unique<SceneData>(std::move(data))),
      bounds_(data_->bounds()),
      rays_((decode_textures(needs, !environment, pool), RayCaster(*data_, pool))),
      triangles_(*data_, pool) {
  has_media_ = std::ranges::any_of(data_->materials,
                                   [](const Material& m) { return m.medium() != nullptr; });
  plain_ = triangles_.stored() && data_->instances.empty() &&
           std::ranges::none_of(data_->materials, [](const Material& m) {
             return m.normal_texture.used() || (m.lacuna && m.lacuna->bump.used());
           });
  if (needs.materials) make_uniform_lobes();
  if (needs.emission) {
    find_contacts(pool);
    emitters_ =
        std::make_unique<EmitterSet>(*data_,
                                     environment          ? load_environment(*environment)
                                     : data_->environment ? environment_of_cube(*data_, pool)
                                                          : nullptr,
                                     bounds_, needs.light_tree);
  }
}

void Scene::find_contacts(const ThreadPool& pool) {
  std::vector<PunctualLight>& lights = data_->lights;
  for_each_chunked(pool, lights.size(), 1024, [&](std::size_t i) {
    PunctualLight& light = lights[i];
    if (light.kind == PunctualLight::Kind::directional) return;
    if (const auto contact = find_contact(light.position)) {
      light.contact = std::make_shared<SurfaceContact>(*contact);
    }
  });
}

std::optional<SurfaceContact> Scene::find_contact(const V3f& x) const {
  return lacuna::find_contact({*data_, rays_, bounds_}, x);
}

Rgb Scene::vertex_color(const Surface& s) const {
  const Mesh& mesh = data_->meshes[s.mesh];
  const V4f c = mesh.mix(mesh.colors, s.triangle, barycentric(s));
  return {c.x, c.y, c.z};
}

Rgb Scene::varying_emission(const Surface& s) const {
  const Rgb emitted = emission(material(s), data_->textures, s.uv);
  return material(s).emits_vertex_colors() ? emitted * vertex_color(s) : emitted;
}

void Scene::make_varying_bsdf(const Surface& s, std::optional<Bsdf>& place) const {
  if (lambertian_[s.material]) {
    Rgb albedo = base_color(material(s), data_->textures, s.uv);
    if (material(s).vertex_colors) albedo *= vertex_color(s);
    place.emplace(albedo, s.ng, s.ns);
    return;
  }
  const Material& m = material(s);
  SurfaceParams params = m.lacuna ? lacuna_params(m, data_->textures, s.uv, bits_of(s))
                                  : surface_params(m, data_->textures, s.uv);
  if (m.vertex_colors) params.base_color *= vertex_color(s);
  if (m.extensions.coat.own_normal) {
    params.coat_normal = coat_normal(*data_, triangles_, s, barycentric(s));
  }
  place.emplace(params, s.ng, s.ns);
}

float Scene::blended_coverage(const Surface& s) const {
  const Mesh& mesh = data_->meshes[s.mesh];
  if (!AlphaMask::needed(*data_, mesh)) return 1;
  constexpr float least = 0x1p-20F;  // where rounding moves a hit to a point of alpha 0
  return std::max(least, AlphaMask(*data_, mesh).coverage(s.triangle, barycentric(s)));
}

void Scene::make_uniform_lobes() {
  uniform_lobes_.resize(data_->materials.size());
  lambertian_.resize(data_->materials.size());
  for (std::size_t i = 0; i < data_->materials.size(); ++i) {
    const Material& m = data_->materials[i];

    lambertian_[i] = is_lambertian(m);
    if (m.varies()) continue;
    uniform_lobes_[i].emplace(m.lacuna ? lacuna_params(m, {}, {}, {}) : surface_params(m, {}, {}));
  }
}

void Scene::set_tangents(const Surface& s, Bsdf& bsdf) const {
  const Material& m = material(s);
  const TextureRef& texture = m.lacuna ? m.lacuna->alpha_texture : m.extensions.anisotropy.texture;
  const auto frame = tangent_frame(*data_, s, barycentric(s), texture);
  const Frame any(s.ns);
  bsdf.set_tangents(frame ? frame->s : any.s, frame ? frame->t : any.t);
}

void Scene::decode_textures(const SceneNeeds& needs, bool own_environment, const ThreadPool& pool) {
  std::set<int> wanted;
  const auto want = [&](const TextureRef& t) {
    if (t.used()) wanted.insert(t.texture);
  };
  for (const Mesh& mesh : data_->meshes) {
    const Material& m = data_->materials[mesh.material];
    if (AlphaMask::needed(*data_, mesh)) want(m.base_color_texture);
    if (needs.emission && m.emits()) want(m.emission_texture);
    if (!needs.materials) continue;
    m.for_each_scattering_texture(want);
    want(m.normal_texture);
    if (m.lacuna) want(m.lacuna->bump);
  }
  if (needs.emission && own_environment && data_->environment) {
    wanted.insert(data_->environment->faces.begin(), data_->environment->faces.end());
  }
  std::vector<Texture*> small;
  std::vector<Texture*> large;
  std::uint64_t texels = 0;
  for (const int i : wanted) {
    Texture* const texture = data_->textures[static_cast<std::size_t>(i)].get();
    const std::uint64_t own = texture->texels();
    (own > max_small_texels ? large : small).push_back(texture);
    texels += own;
  }
  if (texels > max_scene_texels) {
    throw SceneError("the textures have " + std::to_string(texels) +
                     " texels together; allowed: up to " + std::to_string(max_scene_texels));
  }
  for (Texture* texture : large) {
    pool.check_stop();
    texture->decode();
  }
  pool.for_each(static_cast<int>(small.size()),
                [&](int i) { small[static_cast<std::size_t>(i)]->decode(); });
  textures_decoded_ = static_cast<int>(wanted.size());
}

std::uint64_t Scene::texture_bytes() const {
  std::uint64_t sum = 0;
  for (const auto& t : data_->textures) sum += t->bytes();
  return sum;
}

}  // namespace lacuna
