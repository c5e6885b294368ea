#pragma once

#include <algorithm>
#include <array>
#include <memory>

#include "renderer/guides/make_guide.h"
#include "renderer/path/eye_batch.h"
#include "renderer/path/walk.h"
#include "tests/renderer/integrators/render.h"

namespace lacuna::test {

/// A scene, and what a guide knows of it once path tracing has taught it.
class GuidedScene {
 public:
  GuidedScene(const std::function<SceneData()>& make, const GuideSettings& guide, int iterations,
              const std::optional<EnvironmentImage>& environment, int resolution = 24)
      : session_(make(), settings(guide, environment, resolution)),
        eye_(make().cameras.front()),
        camera_(eye_, side, side),
        scene_(make(), {.materials = true, .emission = true}, environment, pool_),
        directions_(make_guiding_distribution(guide)) {
    space_ = std::make_unique<SpaceAnalysis>(
        SpaceInput{.triangles = [this] { return triangle_soup(scene_.data()); },
                   .geometry = geometry_key(scene_.data()),
                   .seeds =
                       [this, everywhere = environment.has_value()] {
                         return domain_seeds(scene_.data(), eye_, everywhere);
                       },
                   .settings = {.resolution = resolution},
                   .byte_limit = [] { return no_memory_limit; }},
        store_, pool_);
    directions_->prepare(context());
    for (int i = 0; i < iterations; ++i) session_.iterate(static_cast<std::uint64_t>(i));
    ByteWriter saved;
    session_.integrator().save(saved);
    ByteReader in(saved.bytes());
    directions_->load(in);
  }

  PrepareContext context() { return {scene_, pool_, *space_, camera_}; }
  SpaceAnalysis& space() { return *space_; }
  const GuidingDistribution& directions() const { return *directions_; }
  const Scene& scene() const { return scene_; }

  /// Vertices of paths from the eye that scatter and have a guiding cell from which directions are
  /// drawn; at most `wanted`, from as many paths as it takes, up to 64. Moved one voxel and a half
  /// off their surfaces: what voxels of the surface itself look like from there, edge-on, no
  /// histogram resolves.
  std::vector<Vertex> guided_vertices(std::size_t wanted) const {
    std::vector<Vertex> found;
    EyeBatch batch(4);
    for (std::size_t i = 0; i < EyeBatch::size; ++i) {
      Rng rng(5, 0, i, Rng::Purpose::test);
      const float x = rng.next() * side;
      batch.start(camera_, rng, camera_.ray(x, rng.next() * side), i);
    }
    Counters counters;
    const Guide guide;
    Walk walk(scene_, guide, {.max_depth = 4, .roulette_depth = 4}, counters);
    walk.trace_paths(batch.states, [&](std::size_t i, int depth) {
      Vertex v = batch.vertex(i, depth);
      if (v.kind != Vertex::Kind::surface || depth == 4 || !v.bsdf->connectible()) return;
      v.guiding_cell = directions_->cell(v.surface, v.wp);
      if (!(v.guiding_cell.probability > 0) || found.size() >= wanted) return;
      const auto away = static_cast<float>(1.5 * space_->voxels().transform.voxel_size);
      v.surface.x += v.surface.ng * std::copysign(away, dot(v.wp, v.surface.ng));
      found.push_back(v);
    });
    return found;
  }

 private:
  static constexpr int side = 16;
  static RenderSettings settings(const GuideSettings& guide,
                                 const std::optional<EnvironmentImage>& environment,
                                 int resolution) {
    PathSettings path;
    path.guide = guide;
    return {.integrator = path,
            .width = 32,
            .height = 32,
            .environment = environment,
            .resolution = resolution};
  }

  Session session_;
  CameraData eye_;
  Camera camera_;
  ThreadPool pool_{2};
  Scene scene_;
  ArtefactStore store_{{}};
  std::unique_ptr<SpaceAnalysis> space_;
  std::unique_ptr<GuidingDistribution> directions_;
};

/// The largest portal of the regions of a scene's empty space, the first of equals; none: it has
/// no portals.
inline std::optional<Portal> largest_portal(SpaceAnalysis& space) {
  const std::vector<Portal>& all = space.portals().portals;
  const auto most = std::max_element(all.begin(), all.end(), [](const Portal& a, const Portal& b) {
    return a.faces() < b.faces();
  });
  return most == all.end() ? std::nullopt : std::optional(*most);
}

/// A point that names a portal and one of its regions (RegionGuideSettings::through): the middle of
/// its middle face.
inline std::array<double, 3> point_of(GuidedScene& scene, const Portal& portal) {
  SpaceAnalysis& space = scene.space();
  const VoxelFace face = space.portals().face(portal, portal.faces() / 2);
  const V3d in_voxels = face.point(space.regions().label.voxel(face.voxel), 0.5, 0.5);
  const V3d at = space.voxels().transform.to_world(in_voxels) + scene.scene().data().origin;
  return {at.x, at.y, at.z};
}

/// That of the largest portal; none: there is no portal.
inline std::optional<std::array<double, 3>> portal_point(
    const std::function<SceneData()>& make, const std::optional<EnvironmentImage>& environment,
    int resolution = 24) {
  PortalsGuideSettings any;
  any.light_rays = 1;
  GuidedScene scene(make, any, 0, environment, resolution);
  const auto portal = largest_portal(scene.space());
  return portal ? std::optional(point_of(scene, *portal)) : std::nullopt;
}

}  // namespace lacuna::test
