#include <fmt/format.h>

#include <algorithm>

#include "jobs/import/mitsuba/materials.h"

namespace lacuna::mitsuba {
namespace {

using MaterialPointer = std::shared_ptr<const ImportedMaterial>;

/// The same material on both sides. `done`: parts that several others share.
ImportedMaterial on_both_sides(const ImportedMaterial& m,
                               std::map<MaterialPointer, MaterialPointer>& done) {
  ImportedMaterial out = m;
  out.one_sided = false;
  for (auto& part : out.parts) {
    MaterialPointer& turned = done[part.material];
    if (!turned)
      turned = std::make_shared<const ImportedMaterial>(on_both_sides(*part.material, done));
    part.material = turned;
  }
  return out;
}

/// Whether a coating may lie over it: it is opaque, and no coating itself (LACUNA_materials).
bool can_be_coated(const ImportedMaterial& m) {
  using Type = ImportedMaterial::Type;
  if (m.type == Type::mixture) {
    return std::ranges::all_of(m.parts, [](const auto& p) { return can_be_coated(*p.material); });
  }
  return m.type != Type::dielectric && m.type != Type::thin_dielectric &&
         m.type != Type::diffuse_transmission && m.type != Type::coating && m.transmission == 0;
}

}  // namespace

std::vector<Materials::Pointer> Materials::inner(const Parameters& p, std::size_t least,
                                                 std::size_t most) {
  const auto elements = p.objects("bsdf");
  if (elements.size() < least || elements.size() > most) {
    p.element().fail(
        fmt::format("has {} BSDFs in it; allowed: {} to {}", elements.size(), least, most));
  }
  std::vector<Pointer> out;
  for (const SceneElement* e : elements) out.push_back(of(*e));
  return out;
}

void Materials::read_two_sided(const Parameters& p, ImportedMaterial& m) {
  const auto sides = inner(p, 1, 2);
  std::map<MaterialPointer, MaterialPointer> done;
  m = on_both_sides(*sides[0], done);
  if (sides.size() == 2 && sides[0] != sides[1]) {
    context_.note(p.element(), "approximated",
                  "its first BSDF is on both sides: there is one for each material");
  }
}

void Materials::read_mask(const Parameters& p, ImportedMaterial& m) {
  m = *inner(p, 1, 1)[0];
  const ImportedValue own = color(p, "opacity", .5F);
  if (m.opacity.texture && own.texture) {
    context_.note(p.element(), "left out", "the opacity of the mask within this one");
  }
  m.opacity.value *= own.value;
  if (own.texture) m.opacity.texture = own.texture;
}

void Materials::read_blend(const Parameters& p, ImportedMaterial& m) {
  const auto parts = inner(p, 2, 2);
  const ImportedValue weight = color(p, "weight", .5F);
  m.type = ImportedMaterial::Type::mixture;
  m.one_sided = false;
  const float w = std::clamp(static_cast<float>(grey_of(weight.value)), 0.0F, 1.0F);
  m.parts = {{parts[0], Rgb(weight.texture ? 1 : 1 - w)}, {parts[1], Rgb(w)}};
  m.weight_texture = weight.texture;
  if (weight.texture) {
    m.parts[1].weight = Rgb(1);
    if (w != 1) context_.note(p.element(), "left out", "the scale of its weight texture");
  }
}

void Materials::read_mixture(const Parameters& p, ImportedMaterial& m) {
  const auto parts = inner(p, 1, 64);
  const auto weights = numbers_in(p.element(), p.text("weights", ""), 64);
  if (weights.size() != parts.size()) {
    p.element().fail(fmt::format("has {} weights for {} BSDFs", weights.size(), parts.size()));
  }
  double sum = 0;
  for (const double w : weights) {
    if (!(w >= 0)) p.element().fail("has a negative weight");
    sum += w;
  }
  const double scale = sum > 1 ? 1 / sum : 1;
  if (sum > 1 + 1e-6) {
    context_.note(p.element(), "approximated",
                  fmt::format("its weights, whose sum is {}, are divided by that", sum));
  }
  if (parts.size() == 1 && weights[0] * scale == 1) {
    m = *parts[0];
    return;
  }
  m.type = ImportedMaterial::Type::mixture;
  m.one_sided = false;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    m.parts.push_back({parts[i], Rgb(static_cast<float>(weights[i] * scale))});
  }
  if (parts.size() == 1) m.parts.push_back({black(), Rgb(0)});
}

void Materials::read_coating(const Parameters& p, ImportedMaterial& m) {
  const Pointer base = inner(p, 1, 1)[0];
  if (!can_be_coated(*base)) {
    m = *base;
    p.ignore_all();
    return context_.note(p.element(), "left out",
                         "the coat over a BSDF that transmits light or is coated itself");
  }
  m.type = ImportedMaterial::Type::coating;
  m.ior = relative_index(p, 1.5046);
  read_facets(p, m, p.element().type() == "roughcoating");
  m.parts = {{base, Rgb(1)}};
  m.one_sided = base->one_sided;
  m.opacity = base->opacity;
  m.thickness = p.number("thickness", 1);
  const ImportedValue absorption = color(p, "sigmaa", 0);
  if (absorption.texture) context_.note(p.element(), "left out", "the texture of its sigmaA");
  m.absorption = absorption.value;
  m.reflectance = color(p, "specularreflectance", 1);
}

ImportedValue Materials::map_within(const Parameters& p) {
  const auto textures = p.objects("texture");
  if (textures.size() != 1) p.element().fail("has no texture in it; required: one");
  return textures_.texture(*textures[0]).value;
}

void Materials::read_bump_map(const Parameters& p, ImportedMaterial& m) {
  m = *inner(p, 1, 1)[0];
  const ImportedValue map = map_within(p);
  m.bump_map = map.texture;
  m.bump_scale = grey_of(map.value) * p.number("scale", 1);
  if (!m.bump_map) context_.note(p.element(), "left out", "its map is no picture");
}

void Materials::read_normal_map(const Parameters& p, ImportedMaterial& m) {
  m = *inner(p, 1, 1)[0];
  const ImportedValue map = map_within(p);
  m.normal_map = map.texture;
  if (!m.normal_map) context_.note(p.element(), "left out", "its map is no picture");
  if (p.boolean("flipinvalidnormals", true) || p.has("usetangentspace")) {
    p.ignore({"usetangentspace"});
  }
}

}  // namespace lacuna::mitsuba
