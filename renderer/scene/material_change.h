#pragma once

#include <string>

#include "analysis/settings/field.h"
#include "renderer/scene/scene_data.h"

namespace lacuna {

/// One of a scene's materials as another would have it: how a method fares with a glossy floor.
struct MaterialChange {
  std::string name;
  double roughness = 1;
  double metallic = 0;
  bool operator==(const MaterialChange&) const = default;
};
template <class V>
void describe(V& v, MaterialChange& s) {
  v("name", s.name,
    {.doc = "of the materials of that name in the file", .min = 1, .max = 1024, .required = true});
  v("roughness", s.roughness,
    {.doc = "as in glTF: GGX's alpha is its square; a texture of it is left out",
     .min = 0,
     .max = 1,
     .required = true});
  v("metallic", s.metallic, {.doc = "as in glTF: 0 a dielectric, 1 a metal", .min = 0, .max = 1});
}

/// `file`: of the scene, for messages. Throws SceneError if no material has that name.
void change_material(SceneData& scene, const MaterialChange& change, const std::string& file);

}  // namespace lacuna
