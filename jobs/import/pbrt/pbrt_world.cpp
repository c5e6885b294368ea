#include <fmt/format.h>

#include "jobs/import/pbrt/pbrt_lights.h"
#include "jobs/import/pbrt/pbrt_materials.h"
#include "jobs/import/pbrt/pbrt_reader.h"
#include "jobs/import/pbrt/pbrt_textures.h"

// Of the reader: the statements that make something, and the scene of it.

namespace lacuna::pbrt {

template <class Map>
void Reader::define(Map Names::*map, const std::string& name) {
  if (!context_.is_v3() || pushed_.empty()) return;
  const auto found = (context_.names.*map).find(name);
  std::optional<typename Map::mapped_type> before;
  if (found != (context_.names.*map).end()) before = found->second;
  pushed_.back().undo.push_back([map, name, before](Names& names) {
    if (before) {
      (names.*map)[name] = *before;
    } else {
      (names.*map).erase(name);
    }
  });
}

void Reader::add_defaults(Parameters& parameters, const char* target) const {
  const auto found = state_.defaults.find(target);
  if (found != state_.defaults.end()) parameters.add_defaults(*found->second);
}

void Reader::note_animation(const Place& place, const std::string& name) {
  if (!state_.ctm.is_animated()) return;
  context_.approximated(place, name, "stands still where it is at the start of the shutter");
}

bool Reader::lacks_inverse(const Place& place, const std::string& name) {
  if (!is_singular(state_.ctm.start())) return false;
  context_.left_out(place, name, "its transform has no inverse");
  return true;
}

void Reader::texture(const Place& place) {
  const std::string name = text(place, "the name of a texture");
  const std::string type = text(place, "float or spectrum");
  Statement s = typed_statement("Texture", place);
  add_defaults(s.parameters, "texture");
  define(type == "float" ? &Names::float_textures : &Names::spectrum_textures, name);
  read_texture(context_, name, type, s.type, s.parameters);
}

void Reader::material(const Place& place) {
  Statement s = typed_statement("Material", place);
  add_defaults(s.parameters, "material");
  const auto entry = std::make_shared<MaterialEntry>();
  *(entry->material = std::make_shared<ImportedMaterial>()) =
      make_material(context_, s.type, s.parameters, entry->invisible);
  entry->defined = true;
  state_.material = entry;
}

void Reader::make_named_material(const Place& place) {
  const std::string name = text(place, "the name of a material");
  Parameters p(tokens_, place, fmt::format("material \"{}\"", name));
  add_defaults(p, "material");
  const std::string type = p.text("type", context_.is_v3() ? "matte" : "diffuse");
  // A second definition of a name is another material for what comes later.
  const auto known = context_.names.materials.find(name);
  if (known != context_.names.materials.end() && known->second->defined) {
    define(&Names::materials, name);
    context_.names.materials.erase(name);
  }
  const auto entry = named_material(context_, name, place);
  entry->defined = true;
  *entry->material = make_material(context_, type, p, entry->invisible);
  entry->material->name = name;
}

void Reader::light(const Place& place) {
  Statement s = typed_statement("LightSource", place);
  add_defaults(s.parameters, "light");
  note_animation(place, s.parameters.owner());
  if (lacks_inverse(place, s.parameters.owner())) return;
  read_light(context_, scene_, s.type, s.parameters, state_.ctm.start());
}

void Reader::shape(const Place& place) {
  Statement s = typed_statement("Shape", place);
  add_defaults(s.parameters, "shape");
  note_animation(place, s.parameters.owner());
  if (lacks_inverse(place, s.parameters.owner())) return;
  const auto geometry = shape_reader_.read(s.type, s.parameters, state_.reversed);
  auto alpha = float_value(context_, s.parameters, "alpha");
  if (s.parameters.find("shadowalpha", {"float", "texture"}) != nullptr) {
    context_.left_out(place, s.parameters.owner(), "an opacity of shadows of its own");
  }
  context_.note_unused(s.parameters);
  if (!geometry) return;
  Shape out;
  out.shape.name = s.type;
  out.shape.place = place.text();
  out.place = place;
  out.shape.mesh = geometry->mesh;
  out.shape.to_world = geometry->to_object * state_.ctm.start();
  out.shape.flipped = geometry->flipped;
  out.material = state_.material;
  out.inside = state_.inside;
  if (state_.area_light != nullptr) {
    emit(out, s.parameters,
         s.type == "trianglemesh" || s.type == "plymesh" || s.type == "loopsubdiv");
    if (alpha && alpha->texture == nullptr && alpha->value.x < 1 && out.shape.radiance) {
      context_.approximated(place, s.parameters.owner(), "a light with an opacity is opaque");
      alpha.reset();
    }
  }
  const bool opaque = !alpha || (alpha->texture == nullptr && alpha->value.x >= 1);
  if (!opaque) out.alpha = alpha;
  add(std::move(out), place);
}

void Reader::emit(Shape& out, const Parameters& parameters, bool of_triangles) {
  if (open_object_) {
    context_.left_out(parameters.place(), parameters.owner(),
                      "the light of a shape within an object, as pbrt has it");
    return;
  }
  const Parameters& p = state_.area_light->parameters;
  const AreaLight light = area_light(
      context_, p.copy_for(p.place(), p.owner()),
      [&] { return areas_of(*out.shape.mesh, out.shape.to_world); }, of_triangles);
  out.shape.radiance = light.radiance;
  out.shape.emits_behind = light.two_sided;
}

void Reader::add(Shape shape, const Place& place) {
  auto& to = open_object_ ? objects_[*open_object_] : shapes_;
  if (to.size() == max_shapes) fail(place, fmt::format("more than {} shapes", max_shapes));
  to.push_back(std::move(shape));
}

void Reader::begin_object(const Place& place) {
  if (open_object_) fail(place, "an object within an object");
  push(Scope::object, place);
  open_object_ = text(place, "the name of an object");
  objects_[*open_object_].clear();
}

void Reader::end_object(const Place& place) {
  pop(Scope::object, place);
  open_object_.reset();
}

void Reader::instance(const Place& place) {
  const std::string name = text(place, "the name of an object");
  const auto found = objects_.find(name);
  if (found == objects_.end()) fail(place, fmt::format("there is no object \"{}\"", name));
  if (open_object_) fail(place, "an instance within an object");
  note_animation(place, "ObjectInstance");
  if (lacks_inverse(place, "ObjectInstance")) return;
  for (const Shape& s : found->second) {
    Shape copy = s;
    copy.shape.to_world = s.shape.to_world * state_.ctm.start();
    add(std::move(copy), place);
  }
}

std::shared_ptr<const ImportedMaterial> Reader::material_of(const Shape& shape) {
  std::shared_ptr<const ImportedMaterial> material = shape.material->material;
  if (shape.inside != nullptr) {
    auto& filled = filled_[{material.get(), shape.inside.get()}];
    if (filled == nullptr) {
      filled = std::make_shared<const ImportedMaterial>(
          filled_with(context_, *material, *shape.inside, shape.place));
    }
    material = filled;
  }
  if (!shape.alpha) return material;
  const ImportedValue& alpha = *shape.alpha;
  auto& cut = cut_out_[{material.get(), alpha.texture.get(), alpha.value.x}];
  if (cut == nullptr) {
    const auto copy = std::make_shared<ImportedMaterial>(*material);
    copy->opacity = alpha;
    cut = copy;
  }
  return cut;
}

ImportedScene Reader::finish() {
  context_.require_materials();
  const View view = read_view(context_, options_);
  M44d mirror;
  if (view.mirrored) mirror.setScale(V3d(-1, 1, 1));
  scene_.cameras = {view.camera};
  scene_.picture = view.picture;
  for (Shape& s : shapes_) {
    if (s.material->invisible && !s.shape.radiance) {
      if (s.inside != nullptr) filled_with(context_, ImportedMaterial(), *s.inside, s.place);
      continue;
    }
    if (s.shape.radiance) s.shape.radiance->value *= view.exposure;
    s.shape.material = material_of(s);
    if (s.shape.material->normal_map && has_mirrored_uvs(*s.shape.mesh, s.shape.flipped)) {
      context_.approximated(s.place, s.material->material->name,
                            "a normal map on mirrored texture coordinates is turned about u");
    }
    s.shape.to_world = s.shape.to_world * mirror;
    scene_.shapes.push_back(std::move(s.shape));
  }
  for (ImportedLight& light : scene_.lights) {
    light.intensity *= view.exposure;
    light.position = light.position * mirror;
    light.direction = light.direction * mirror;
  }
  if (scene_.environment) {
    scene_.environment->scale *= view.exposure;
    M44d turn = scene_.environment->to_world;
    turn[3][0] = turn[3][1] = turn[3][2] = 0;
    scene_.environment->to_world = turn * mirror;
  }
  scene_.notes = context_.notes();
  return std::move(scene_);
}

}  // namespace lacuna::pbrt
