#include "renderer/scene/material_change.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <set>

namespace lacuna {

void change_material(SceneData& scene, const MaterialChange& change, const std::string& file) {
  std::set<std::string> names;
  bool found = false;
  for (Material& m : scene.materials) {
    if (!m.name.empty()) names.insert(m.name);
    if (m.name != change.name) continue;
    if (m.lacuna) {
      throw SceneError(
          fmt::format("material \"{}\" of scene \"{}\" has LACUNA_materials: its "
                      "roughness and metallic are not used",
                      m.name, file));
    }
    m.roughness = static_cast<float>(change.roughness);
    m.metallic = static_cast<float>(change.metallic);
    m.metallic_roughness_texture = {};
    found = true;
  }
  if (found) return;
  throw SceneError(fmt::format("scene \"{}\" has no material \"{}\"; it has \"{}\"", file,
                               change.name, fmt::join(names, "\", \"")));
}

}  // namespace lacuna
