#include "jobs/import/pbrt/pbrt_media.h"

#include <fmt/format.h>

#include <algorithm>

#include "jobs/import/pbrt/pbrt_colours.h"

namespace lacuna::pbrt {

Medium read_medium(Context& context, const std::string& name, const Parameters& p) {
  Medium out;
  out.place = p.place();
  out.name = fmt::format("medium \"{}\"", name);
  const bool named = p.find("preset", {"string"}) != nullptr;
  out.uniform = p.text("type", "") == "homogeneous" && !named;
  if (!out.uniform) {
    for (const Parameter& x : p.all()) x.used = true;
    return out;
  }
  const auto coefficient = [&](const char* key, const Rgb& otherwise) {
    const Parameter* c = p.find_spectrum(key);
    Rgb value = c == nullptr ? otherwise : reflected_colour(context, *c);
    // A colour of another space may lie outside of ours.
    for (int i = 0; i < 3; ++i) value[i] = std::max(0.0F, value[i]);
    return value;
  };
  const auto scale = static_cast<float>(p.number_in("scale", 1, 0, 1e9));
  out.absorption = coefficient("sigma_a", {.0011F, .0024F, .014F}) * scale;
  out.scatters = coefficient("sigma_s", {2.55F, 3.21F, 3.77F}) * scale != Rgb(0, 0, 0);
  p.ignore({"g"});
  context.note_unused(p);
  return out;
}

ImportedMaterial filled_with(Context& context, const ImportedMaterial& material,
                             const Medium& medium, const Place& place) {
  ImportedMaterial out = material;
  if (!medium.uniform) {
    context.left_out(place, medium.name, "media that are read: homogeneous ones, by coefficients");
  } else if (material.type != ImportedMaterial::Type::dielectric) {
    context.left_out(place, medium.name, "a medium within what is no dielectric");
  } else {
    out.absorption = medium.absorption;
    if (medium.scatters) {
      context.approximated(medium.place, medium.name,
                           "what it absorbs is read, not what it scatters");
    }
  }
  return out;
}

}  // namespace lacuna::pbrt
