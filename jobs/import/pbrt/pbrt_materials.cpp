#include "jobs/import/pbrt/pbrt_materials.h"

#include <fmt/format.h>

#include <algorithm>

#include "jobs/import/pbrt/pbrt_colours.h"
#include "jobs/import/pbrt/pbrt_textures.h"

namespace lacuna::pbrt {
namespace {

/// The parts of a mix: v4 has a list `materials`, v3 `namedmaterial1` and `namedmaterial2`.
std::array<std::shared_ptr<MaterialEntry>, 2> parts_of_mix(Context& context, const Parameters& p) {
  std::array<std::string, 2> names{p.text("namedmaterial1", ""), p.text("namedmaterial2", "")};
  if (const Parameter* list = p.find("materials", {"string"})) {
    if (list->texts.size() != 2) fail(list->place, "mix: \"materials\" must be two names");
    names = {list->texts[0], list->texts[1]};
  }
  for (const std::string& name : names) {
    if (name.empty()) fail(p.place(), "mix: the names of two materials are missing");
  }
  return {named_material(context, names[0], p.place()),
          named_material(context, names[1], p.place())};
}

ImportedMaterial mix(Context& context, const Parameters& p) {
  const auto parts = parts_of_mix(context, p);
  ImportedMaterial out;
  out.type = ImportedMaterial::Type::mixture;
  // pbrt-v3: the weight of the first, a colour; pbrt-v4: that of the second.
  auto amount = float_value(context, p, "amount");
  if (!amount) amount = colour_value(context, p, "amount", 0.5F);
  const bool v3 = context.is_v3();
  Rgb weight = amount->value;
  for (int c = 0; c < 3; ++c) weight[c] = std::clamp(weight[c], 0.0F, 1.0F);
  const Rgb rest = Rgb(1, 1, 1) - weight;
  out.parts = {{parts[0]->material, v3 ? weight : rest}, {parts[1]->material, v3 ? rest : weight}};
  if (amount->texture == nullptr) return out;
  // The texture is the weight of the second part.
  if (amount->value != Rgb(1, 1, 1)) {
    context.approximated(p.place(), p.owner(), "the factor of the texture of \"amount\" is 1");
  }
  if (v3) std::swap(out.parts[0], out.parts[1]);
  out.parts[0].weight = out.parts[1].weight = Rgb(1, 1, 1);
  out.weight_texture = amount->texture;
  return out;
}

void read_bumps(Context& context, const Parameters& p, ImportedMaterial& material) {
  auto height = float_value(context, p, "displacement");
  if (!height) height = float_value(context, p, "bumpmap");
  if (height && height->texture != nullptr) {
    material.bump_map = height->texture;
    material.bump_scale = double(height->value.x);
  }
  const std::string normals = p.text("normalmap", "");
  if (normals.empty()) return;
  if (const auto texture = picture(context, p, normals)) {
    texture->srgb = false;
    material.normal_map = texture;
  }
}

/// The lobes of one material of pbrt, which are parts of a mixture here, have its bumps, and its
/// name in notes.
void move_bumps_to_parts(ImportedMaterial& material) {
  if (material.type != ImportedMaterial::Type::mixture) return;
  for (auto& part : material.parts) {
    auto copy = std::make_shared<ImportedMaterial>(*part.material);
    copy->bump_map = material.bump_map;
    copy->bump_scale = material.bump_scale;
    copy->normal_map = material.normal_map;
    copy->name = material.name;
    copy->place = material.place;
    move_bumps_to_parts(*copy);
    part.material = std::move(copy);
  }
  material.bump_map = material.normal_map = nullptr;
}

}  // namespace

ImportedMaterial mixture_of(const ImportedMaterial& first, const Rgb& weight,
                            const ImportedMaterial& second, const Rgb& second_weight) {
  ImportedMaterial out;
  out.type = ImportedMaterial::Type::mixture;
  out.parts = {{std::make_shared<ImportedMaterial>(first), weight},
               {std::make_shared<ImportedMaterial>(second), second_weight}};
  return out;
}

ImportedMaterial perfect_mirror(const ImportedValue& reflectance) {
  ImportedMaterial m;
  m.type = ImportedMaterial::Type::conductor;
  m.eta = Rgb(0, 0, 0);
  m.k = Rgb(1, 1, 1);
  m.reflectance = reflectance;
  return m;
}

ImportedMaterial diffuse_both_sides(Context& context, const Parameters& parameters,
                                    const ImportedValue& reflected,
                                    const ImportedValue& transmitted) {
  ImportedMaterial front, behind;
  behind.type = ImportedMaterial::Type::diffuse_transmission;
  front.diffuse = reflected;
  behind.transmittance = transmitted;
  const float r = max_component(reflected.value), t = max_component(transmitted.value);
  if (!(t > 0)) return front;
  if (!(r > 0)) return behind;
  // f = w (R / w) + (1 - w) (T / (1 - w)) for any w; both colours lie in [0, 1] if r + t <= 1.
  if (r + t > 1) {
    context.approximated(parameters.place(), parameters.owner(),
                         "reflectance and transmittance together are scaled to 1");
  }
  const float weight = r / (r + t), scale = std::max(r + t, 1.0F);
  front.diffuse.value /= weight * scale;
  behind.transmittance.value /= (1 - weight) * scale;
  return mixture_of(front, Rgb(weight, weight, weight), behind,
                    Rgb(1 - weight, 1 - weight, 1 - weight));
}

std::shared_ptr<MaterialEntry> named_material(Context& context, const std::string& name,
                                              const Place& place) {
  auto& entry = context.names.materials[name];
  if (entry == nullptr) {
    entry = std::make_shared<MaterialEntry>();
    entry->material = std::make_shared<ImportedMaterial>();
    entry->first_use = place;
    entry->name = name;
    context.expect(entry);
  }
  return entry;
}

ImportedMaterial make_material(Context& context, const std::string& type,
                               const Parameters& parameters, bool& invisible) {
  parameters.ignore({"type"});
  invisible = type == "interface" || type == "none" || type.empty();
  ImportedMaterial out;
  if (type == "mix") {
    out = mix(context, parameters);
  } else if (!invisible) {
    auto made = make_v4_material(context, type, parameters);
    if (!made) made = make_v3_material(context, type, parameters);
    if (!made) {
      fail(parameters.place(),
           fmt::format(
               "material \"{}\"; allowed: diffuse, coateddiffuse, conductor, "
               "coatedconductor, dielectric, thindielectric, diffusetransmission, mix, "
               "interface, subsurface, hair, measured (pbrt-v4); matte, plastic, uber, "
               "substrate, metal, mirror, glass, translucent, disney, kdsubsurface, fourier, "
               "none (pbrt-v3)",
               type));
    }
    out = std::move(*made);
  }
  read_bumps(context, parameters, out);
  out.name = type;
  out.place = parameters.place().text();
  if (type != "mix") move_bumps_to_parts(out);
  context.note_unused(parameters);
  return out;
}

}  // namespace lacuna::pbrt
