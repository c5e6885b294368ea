#include "jobs/import/pbrt/pbrt_reader.h"

#include <fmt/format.h>

#include "jobs/import/pbrt/pbrt_colours.h"
#include "jobs/import/pbrt/pbrt_materials.h"

namespace lacuna::pbrt {
namespace {

/// Of parameters that many later statements copy.
void require_few_values(const Parameters& p) {
  constexpr std::size_t most = 4096;
  std::size_t count = 0;
  for (const Parameter& x : p.all()) count += x.numbers.size() + x.texts.size();
  if (count > most) fail(p.place(), fmt::format("{}: more than {} values", p.owner(), most));
}

}  // namespace

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
      context_.left_out(place, "CoordSysTransform",
                        fmt::format("there is no coordinate system \"{}\"", key));
    } else {
      state_.ctm.set(found->second);
    }
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
    if (is_singular(state_.ctm.start())) fail(place, "Camera: its transform has no inverse");
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
    pixel_filter(typed_statement(name, place));
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

void Reader::pixel_filter(const Statement& filter) {
  const Parameters& p = filter.parameters;
  const double otherwise = filter.type == "box" ? 0.5 : 2;
  const double x = p.number("xradius", p.number("xwidth", otherwise));
  const double y = p.number("yradius", p.number("ywidth", otherwise));
  options_.tent_filter = filter.type == "triangle" && x == 1 && y == 1;
  const bool box = filter.type == "box" && x == 0.5 && y == 0.5;
  if (!box && !options_.tent_filter) {
    context_.left_out(p.place(), p.owner(), "the job's pixel_filter is a box; it can be a tent");
  }
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
    require_few_values(area->parameters);
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
    named_medium(place);
  } else {
    return false;
  }
  return true;
}

void Reader::push(Scope scope, const Place& place) {
  if (pushed_.size() == max_nesting) {
    fail(place, fmt::format("attributes are nested {} deep, which is the limit", max_nesting));
  }
  pushed_.push_back({scope, place, state_, {}});
}

void Reader::pop(Scope scope, const Place& place) {
  if (pushed_.empty() || pushed_.back().scope != scope) {
    fail(place, pushed_.empty() ? "nothing begins that ends here"
                                : fmt::format("what begins at {} does not end before this",
                                              pushed_.back().place.text()));
  }
  Pushed p = std::move(pushed_.back());
  pushed_.pop_back();
  if (scope != Scope::transform) {
    state_ = std::move(p.state);
    for (; !p.undo.empty(); p.undo.pop_back()) p.undo.back()(context_.names);
    return;
  }
  state_.ctm = p.state.ctm;
  if (pushed_.empty()) return;
  auto& undo = pushed_.back().undo;
  undo.insert(undo.end(), p.undo.begin(), p.undo.end());
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
  add_defaults(p, target.c_str());
  require_few_values(p);
  state_.defaults[target] = std::make_shared<const Parameters>(std::move(p));
}

void Reader::named_medium(const Place& place) {
  const std::string name = text(place, "the name of a medium");
  Parameters p(tokens_, place, fmt::format("medium \"{}\"", name));
  add_defaults(p, "medium");
  media_[name] = std::make_shared<const Medium>(read_medium(context_, name, p));
}

/// The second name is that of the outside; one name stands for both.
void Reader::medium_interface(const Place& place) {
  const std::string inside = text(place, "the name of a medium");
  std::string outside = inside;
  if (tokens_.peek() && tokens_.peek()->kind == Token::Kind::text) outside = tokens_.next()->text;
  if (!outside.empty()) {
    context_.left_out(place, "MediumInterface", "the medium outside: space is empty");
  }
  const auto found = media_.find(inside);
  state_.inside = found == media_.end() ? nullptr : found->second;
  if (!inside.empty() && found == media_.end()) {
    context_.left_out(place, "MediumInterface", fmt::format("there is no medium \"{}\"", inside));
  }
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

}  // namespace lacuna::pbrt
