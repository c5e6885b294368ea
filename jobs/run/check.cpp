#include "jobs/run/check.h"
#include "jobs/run/prepare.h"
#include "jobs/run/reference.h"
#include "renderer/gltf/gltf_load.h"

#include <fmt/format.h>

#include <algorithm>
#include <numbers>
#include <optional>
#include <span>
#include <utility>

#include "renderer/scene/close_surfaces.h"
#include "renderer/scene/hidden_emitters.h"
#include "renderer/scene/nested_solids.h"
#include "renderer/scene/points_in_surfaces.h"

namespace lacuna {

std::vector<std::string> check_job(const JobSpec& spec, const RunContext& context) {
  Prepared prepared = prepare(spec, context);
  if (!spec.reference.empty() && spec.reference != "auto") {
    find_reference(spec, context.data, context.scenes);
  }
  return prepared.warnings;
}

namespace {

/// `"name": {"position": ..., ...}`, in the coordinates of the file.
std::string view_of(const CameraData& camera, const V3d& origin) {
  const M44d& m = camera.to_world;
  const V3d position = V3d(m[3][0], m[3][1], m[3][2]) + origin;
  const V3d up(m[1][0], m[1][1], m[1][2]), back(m[2][0], m[2][1], m[2][2]);
  const auto point = [](const V3d& p) {
    return fmt::format("[{:.6g}, {:.6g}, {:.6g}]", p.x, p.y, p.z);
  };
  const std::string extent =
      camera.projection == Projection::orthographic
          ? fmt::format("\"type\": \"orthographic\", \"height\": {:.6g}", camera.height)
          : fmt::format("\"fov\": {:.6g}", camera.yfov * 180 / std::numbers::pi);
  return fmt::format("\"{}\": {{\"position\": {}, \"target\": {}, \"up\": {}, {}}}", camera.name,
                     point(position), point(position - back), point(up), extent);
}

}  // namespace

SceneCounts check_scene(const std::filesystem::path& file, const SceneChoice& choice,
                        const ThreadPool& pool) {
  if (const std::string kind = file.extension().string(); kind != ".glb" && kind != ".gltf") {
    throw SceneError(
        fmt::format("\"{}\" ends in \"{}\"; allowed: .glb and .gltf; Blender's glTF exporter "
                    "converts other formats, or `assimp export {} {}`",
                    file.string(), kind, file.filename().string(), file.stem().string() + ".glb"));
  }
  SceneData data = load_gltf(file, nullptr, choice);
  // Without glTF's own material, and copies for vertex colours.
  const auto materials = std::ranges::count(data.materials, false, &Material::vertex_colors) - 1;
  SceneCounts counts{data.triangle_count(),
                     static_cast<std::size_t>(materials),
                     data.textures.size(),
                     data.cameras.size(),
                     data.lights.size(),
                     data.bounds(),
                     data.warnings,
                     features_of(file),
                     {}};
  counts.box.low += data.origin;
  counts.box.high += data.origin;
  constexpr std::size_t most_views = 16;
  for (const CameraData& camera :
       std::span(data.cameras).first(std::min(most_views, data.cameras.size()))) {
    counts.views.push_back(view_of(camera, data.origin));
  }
  const Scene scene(std::move(data), {.materials = true, .emission = true}, std::nullopt, pool);
  for (const std::vector<std::string>& found : {close_surfaces(scene, pool), hidden_emitters(scene),
                                                lights_in_surfaces(scene), nested_solids(scene)}) {
    counts.warnings.insert(counts.warnings.end(), found.begin(), found.end());
  }
  return counts;
}

}  // namespace lacuna
