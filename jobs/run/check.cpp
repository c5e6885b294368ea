#include "jobs/run/check.h"
#include "jobs/run/prepare.h"
#include "jobs/run/reference.h"
#include "renderer/gltf/gltf_load.h"

#include <fmt/format.h>

#include <optional>
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

SceneCounts check_scene(const std::filesystem::path& file, const ThreadPool& pool) {
  if (const std::string kind = file.extension().string(); kind != ".glb" && kind != ".gltf") {
    throw SceneError(
        fmt::format("\"{}\" ends in \"{}\"; allowed: .glb and .gltf; Blender's glTF exporter "
                    "converts other formats, or `assimp export {} {}`",
                    file.string(), kind, file.filename().string(), file.stem().string() + ".glb"));
  }
  SceneData data = load_gltf(file);
  SceneCounts counts{data.triangle_count(), data.materials.size() - 1,  // without glTF's own
                     data.textures.size(),  data.cameras.size(),
                     data.lights.size(),    data.warnings};
  const Scene scene(std::move(data), {.materials = true, .emission = true}, std::nullopt, pool);
  for (const auto& looks : {close_surfaces, hidden_emitters, lights_in_surfaces, nested_solids}) {
    for (std::string& w : looks(scene)) counts.warnings.push_back(std::move(w));
  }
  return counts;
}

}  // namespace lacuna
