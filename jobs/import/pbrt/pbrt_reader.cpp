#include "jobs/import/pbrt/pbrt_reader.h"

#include <fmt/format.h>

#include <algorithm>

#include "jobs/import/pbrt/pbrt_colours.h"
#include "jobs/import/pbrt/pbrt_lights.h"
#include "jobs/import/pbrt/pbrt_materials.h"
#include "jobs/import/pbrt/pbrt_textures.h"

namespace lacuna::pbrt {

Reader::Reader(const std::filesystem::path& file, Version version)
    : context_(file, version), tokens_(file), shape_reader_(context_) {
  const auto entry = std::make_shared<MaterialEntry>();
  entry->material = std::make_shared<ImportedMaterial>();
  entry->material->name = "default";
  entry->defined = true;
  state_.material = entry;
}

void Reader::read() {
  while (const auto token = tokens_.next()) {
    close_imports();
    if (token->kind != Token::Kind::word) {
      fail(token->place, fmt::format("found {}; expected a statement", token->text));
    }
    if (ended_) {
      context_.left_out(token->place, "WorldEnd", "what follows it");
      break;
    }
    statement(*token);
  }
  if (!pushed_.empty() && pushed_.back().scope != Scope::import) {
    fail(pushed_.back().place, "what begins here does not end");
  }
}

void Reader::statement(const Token& word) {
  const std::string_view name = word.text;
  context_.colours = state_.colours;
  if (read_transform(name, tokens_, word.place, state_.ctm)) return;
  if (scope_statement(name, word.place) || coordinate_statement(name, word.place) ||
      option_statement(name, word.place) || world_statement(name, word.place)) {
    return;
  }
  if (name == "SurfaceIntegrator" || name == "VolumeIntegrator" || name == "Renderer" ||
      name == "Volume") {
    fail(word.place,
         fmt::format("{} belongs to pbrt-v2; allowed: files of pbrt-v3 and pbrt-v4", name));
  }
  fail(word.place, fmt::format("unknown statement \"{}\"", name));
}

bool Reader::scope_statement(std::string_view name, const Place& place) {
  if (name == "AttributeBegin") {
    push(Scope::attribute, place);
  } else if (name == "AttributeEnd") {
    pop(Scope::attribute, place);
  } else if (name == "TransformBegin") {
    push(Scope::transform, place);
  } else if (name == "TransformEnd") {
    pop(Scope::transform, place);
  } else if (name == "ObjectBegin") {
    begin_object(place);
  } else if (name == "ObjectEnd") {
    end_object(place);
  } else if (name == "Include" || name == "Import") {
    include(place, name == "Import");
  } else if (name == "WorldBegin") {
    begin_world(place);
  } else if (name == "WorldEnd") {
    ended_ = true;
  } else {
    return false;
  }
  return true;
}

bool Reader::coordinate_statement(std::string_view name, const Place& place) {
  if (name == "CoordinateSystem") {
    coordinate_systems_[text(place, "the name of a coordinate system")] = state_.ctm.start();
  } else if (name == "CoordSysTransform") {
    const std::string key = text(place, "the name of a coordinate system");
    const auto found = coordinate_systems_.find(key);
    if (found == coordinate_systems_.end()) {
      fail(place, fmt::format("there is no coordinate system \"{}\"", key));
    }
    state_.ctm.set(found->second);
  } else if (name == "ReverseOrientation") {
    state_.reversed = !state_.reversed;
  } else if (name == "ActiveTransform") {
    const auto which = tokens_.next();
    if (!which) fail(place, "ActiveTransform: expected All, StartTime or EndTime");
    state_.ctm.activate(*which);
  } else if (name == "TransformTimes") {
    for (int i = 0; i < 2; ++i) {
      const auto token = tokens_.next();
      if (!token || !number_of(token->text)) fail(place, "TransformTimes: expected two numbers");
    }
  } else {
    return false;
  }
  return true;
}

bool Reader::option_statement(std::string_view name, const Place& place) {
  if (name == "Camera") {
    options_.camera = typed_statement(name, place);
    options_.world_from_camera = state_.ctm.start().inverse();
    coordinate_systems_["camera"] = options_.world_from_camera;
    note_animation(place, "Camera");
  } else if (name == "Film") {
    options_.film = typed_statement(name, place);
  } else if (name == "Integrator") {
    options_.integrator = typed_statement(name, place);
  } else if (name == "Sampler" || name == "Accelerator") {
    typed_statement(name, place);  // no part of the picture that a render converges to
  } else if (name == "PixelFilter") {
    const Statement filter = typed_statement(name, place);
    context_.left_out(place, filter.parameters.owner(), "the job's own filter is used");
  } else if (name == "ColorSpace") {
    state_.colours = colour_space(text(place, "a colour space"), place);
  } else if (name == "Option") {
    const Parameters option(tokens_, place, "Option");
    option.ignore({"seed", "quiet", "gpu", "wavefront", "disablepixeljitter",
                   "disablewavelengthjitter", "rendercoordsys", "msereferenceimage",
                   "msereferenceout"});
    context_.note_unused(option);
  } else {
    return false;
  }
  return true;
}

bool Reader::world_statement(std::string_view name, const Place& place) {
  if (name == "Shape") {
    shape(place);
  } else if (name == "LightSource") {
    light(place);
  } else if (name == "AreaLightSource") {
    auto area = std::make_shared<Statement>(typed_statement(name, place));
    if (area->type != "diffuse" && area->type != "area") {
      fail(place, fmt::format("area light \"{}\"; allowed: diffuse", area->type));
    }
    state_.area_light = std::move(area);
  } else if (name == "Material") {
    material(place);
  } else if (name == "MakeNamedMaterial") {
    make_named_material(place);
  } else if (name == "NamedMaterial") {
    state_.material = named_material(context_, text(place, "the name of a material"), place);
  } else if (name == "Texture") {
    texture(place);
  } else if (name == "ObjectInstance") {
    instance(place);
  } else if (name == "Attribute") {
    attribute(place);
  } else if (name == "MediumInterface") {
    medium_interface(place);
  } else if (name == "MakeNamedMedium") {
    typed_statement(name, place);
    context_.left_out(place, "MakeNamedMedium", "media: space is empty");
  } else {
    return false;
  }
  return true;
}

void Reader::push(Scope scope, const Place& place) {
  if (pushed_.size() == max_nesting) {
    fail(place, fmt::format("attributes are nested {} deep, which is the limit", max_nesting));
  }
  pushed_.push_back({scope, place, state_, context_.names});
}

void Reader::pop(Scope scope, const Place& place) {
  if (pushed_.empty() || pushed_.back().scope != scope) {
    fail(place, pushed_.empty() ? "nothing begins that ends here"
                                : fmt::format("what begins at {} does not end before this",
                                              pushed_.back().place.text()));
  }
  Pushed& p = pushed_.back();
  if (scope == Scope::transform) {
    state_.ctm = p.state.ctm;
  } else {
    state_ = std::move(p.state);
    if (context_.is_v3()) context_.names = std::move(p.names);
  }
  pushed_.pop_back();
}

Names& Reader::own_names() {
  // In pbrt-v3 a definition ends with its scope; in pbrt-v4 names are those of the whole scene.
  if (context_.is_v3() && context_.names.use_count() > 1) {
    context_.names = std::make_shared<Names>(*context_.names);
  }
  return *context_.names;
}

void Reader::include(const Place& place, bool import) {
  const std::string name = text(place, "the name of a file");
  const auto file = context_.resolve(name, place);
  std::error_code none;
  if (!std::filesystem::is_regular_file(file, none)) {
    fail(place, fmt::format("file \"{}\" does not exist", name));
  }
  if (import) {
    imports_.push_back(tokens_.depth());
    push(Scope::import, place);
  }
  tokens_.include(file, place);
}

/// Import changes nothing of the state of its file.
void Reader::close_imports() {
  while (!imports_.empty() && tokens_.depth() <= imports_.back()) {
    imports_.pop_back();
    pop(Scope::import, pushed_.empty() ? Place{} : pushed_.back().place);
  }
}

void Reader::begin_world(const Place& place) {
  if (in_world_) fail(place, "a second WorldBegin");
  in_world_ = true;
  state_.ctm = CurrentTransform();
  coordinate_systems_["world"] = M44d();
}

void Reader::attribute(const Place& place) {
  const std::string target = text(place, "what the attributes are for");
  if (target != "shape" && target != "light" && target != "material" && target != "medium" &&
      target != "texture") {
    fail(place,
         fmt::format("Attribute \"{}\"; allowed: shape, light, material, medium, texture", target));
  }
  Parameters p(tokens_, place, fmt::format("Attribute \"{}\"", target));
  p.add_defaults(state_.defaults[target]);
  state_.defaults[target] = std::move(p);
}

void Reader::medium_interface(const Place& place) {
  bool any = !text(place, "the name of a medium").empty();
  if (tokens_.peek() && tokens_.peek()->kind == Token::Kind::text)
    any |= !tokens_.next()->text.empty();
  if (any) context_.left_out(place, "MediumInterface", "media: space is empty");
}

std::string Reader::text(const Place& place, const char* what) {
  auto token = tokens_.next();
  const bool brackets = token && token->kind == Token::Kind::open;
  if (brackets) token = tokens_.next();
  if (!token || token->kind != Token::Kind::text) {
    fail(token ? token->place : place,
         fmt::format("found {}; expected {} in quotes", token ? token->text : "the end", what));
  }
  std::string out(token->text);
  if (brackets) {
    const auto end = tokens_.next();
    if (!end || end->kind != Token::Kind::close) fail(place, "expected ]");
  }
  return out;
}

Statement Reader::typed_statement(std::string_view name, const Place& place) {
  Statement out;
  out.type = text(place, "a type");
  out.parameters = Parameters(tokens_, place, fmt::format("{} \"{}\"", name, out.type));
  return out;
}

void Reader::note_animation(const Place& place, const std::string& name) {
  if (!state_.ctm.is_animated()) return;
  context_.approximated(place, name, "stands still where it is at the start of the shutter");
}

void Reader::texture(const Place& place) {
  const std::string name = text(place, "the name of a texture");
  const std::string type = text(place, "float or spectrum");
  Statement s = typed_statement("Texture", place);
  s.parameters.add_defaults(state_.defaults["texture"]);
  own_names();
  read_texture(context_, name, type, s.type, s.parameters);
}

void Reader::material(const Place& place) {
  Statement s = typed_statement("Material", place);
  s.parameters.add_defaults(state_.defaults["material"]);
  const auto entry = std::make_shared<MaterialEntry>();
  *(entry->material = std::make_shared<ImportedMaterial>()) =
      make_material(context_, s.type, s.parameters, entry->invisible);
  entry->defined = true;
  state_.material = entry;
}

void Reader::make_named_material(const Place& place) {
  const std::string name = text(place, "the name of a material");
  Parameters p(tokens_, place, fmt::format("material \"{}\"", name));
  p.add_defaults(state_.defaults["material"]);
  const std::string type = p.text("type", context_.is_v3() ? "matte" : "diffuse");
  // A second definition of a name is another material for what comes later.
  Names& names = own_names();
  const auto known = names.materials.find(name);
  if (known != names.materials.end() && known->second->defined) names.materials.erase(known);
  const auto entry = named_material(context_, name, place);
  entry->defined = true;
  *entry->material = make_material(context_, type, p, entry->invisible);
  entry->material->name = name;
}

void Reader::light(const Place& place) {
  Statement s = typed_statement("LightSource", place);
  s.parameters.add_defaults(state_.defaults["light"]);
  note_animation(place, s.parameters.owner());
  read_light(context_, scene_, s.type, s.parameters, state_.ctm.start());
}

void Reader::shape(const Place& place) {
  Statement s = typed_statement("Shape", place);
  s.parameters.add_defaults(state_.defaults["shape"]);
  note_animation(place, s.parameters.owner());
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
  out.shape.mesh = geometry->mesh;
  out.shape.to_world = geometry->to_object * state_.ctm.start();
  out.shape.flipped = geometry->flipped;
  out.material = state_.material;
  if (state_.area_light != nullptr) {
    emit(out, s.parameters,
         s.type == "trianglemesh" || s.type == "plymesh" || s.type == "loopsubdiv");
    if (alpha && alpha->texture == nullptr && out.shape.radiance) {
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
  const AreaLight light = area_light(context_, p.copy_for(p.place(), p.owner()),
                                     areas_of(*out.shape.mesh, out.shape.to_world), of_triangles);
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
  for (const Shape& s : found->second) {
    Shape copy = s;
    copy.shape.to_world = s.shape.to_world * state_.ctm.start();
    add(std::move(copy), place);
  }
}

std::shared_ptr<const ImportedMaterial> Reader::material_of(const Shape& shape) {
  const auto& material = shape.material->material;
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
    if (s.material->invisible && !s.shape.radiance) continue;
    if (s.shape.radiance) s.shape.radiance->value *= view.exposure;
    s.shape.material = material_of(s);
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
