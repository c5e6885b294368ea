#include "jobs/import/mitsuba/materials.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/json/json_cursor.h"
#include "jobs/import/spectrum.h"

namespace lacuna::mitsuba {
namespace {

constexpr std::size_t max_bsdf_depth = 16;
// What Mitsuba takes for an inside and an outside that are not named.
constexpr double bk7 = 1.5046, polypropylene = 1.49, air = 1.000277;

}  // namespace

Materials::Read Materials::reader_of(const std::string& type) {
  static const std::map<std::string, Read> readers{
      {"diffuse", &Materials::read_diffuse},
      {"lambertian", &Materials::read_diffuse},
      {"roughdiffuse", &Materials::read_diffuse},
      {"difftrans", &Materials::read_diffuse_transmission},
      {"conductor", &Materials::read_conductor},
      {"roughconductor", &Materials::read_conductor},
      {"dielectric", &Materials::read_dielectric},
      {"roughdielectric", &Materials::read_dielectric},
      {"thindielectric", &Materials::read_dielectric},
      {"plastic", &Materials::read_plastic},
      {"roughplastic", &Materials::read_plastic},
      {"phong", &Materials::read_phong},
      {"ward", &Materials::read_ward},
      {"principled", &Materials::read_principled},
      {"principledthin", &Materials::read_thin_principled},
      {"pplastic", &Materials::read_plastic},
      {"null", &Materials::read_null},
      {"polarizer", &Materials::read_filter},
      {"retarder", &Materials::read_filter},
      {"circular", &Materials::read_filter},
      {"twosided", &Materials::read_two_sided},
      {"mask", &Materials::read_mask},
      {"blendbsdf", &Materials::read_blend},
      {"blend", &Materials::read_blend},
      {"mixturebsdf", &Materials::read_mixture},
      {"mixture", &Materials::read_mixture},
      {"coating", &Materials::read_coating},
      {"roughcoating", &Materials::read_coating},
      {"bumpmap", &Materials::read_bump_map},
      {"normalmap", &Materials::read_normal_map}};
  const auto found = readers.find(type);
  return found == readers.end() ? &Materials::read_other : found->second;
}

Materials::Pointer Materials::of(const SceneElement& bsdf) {
  if (const auto found = known_.find(&bsdf); found != known_.end()) return found->second;
  if (std::find(open_.begin(), open_.end(), &bsdf) != open_.end()) {
    bsdf.fail("is within itself: a circle");
  }
  if (open_.size() >= max_bsdf_depth) bsdf.fail("is nested more than 16 BSDFs deep");
  const Read read = reader_of(bsdf.type());
  open_.push_back(&bsdf);
  const Parameters p = context_.parameters(bsdf);
  ImportedMaterial m;
  m.one_sided = true;
  m.place = bsdf.place;
  m.name = bsdf.has("id") ? bsdf.attribute("id") : bsdf.attribute("name");
  const std::string name = m.name.empty() ? bsdf.type() : m.name;
  (this->*read)(p, m);
  m.name = name;
  m.place = bsdf.place;
  p.note_unread(context_.notes);
  open_.pop_back();
  return known_[&bsdf] = std::make_shared<const ImportedMaterial>(std::move(m));
}

Materials::Pointer Materials::fallback() {
  if (!fallback_) {
    ImportedMaterial m;
    m.name = "default";
    m.one_sided = true;
    fallback_ = std::make_shared<const ImportedMaterial>(std::move(m));
  }
  return fallback_;
}

Materials::Pointer Materials::black() {
  if (!black_) {
    ImportedMaterial m;
    m.name = "black";
    m.type = ImportedMaterial::Type::black;
    black_ = std::make_shared<const ImportedMaterial>(std::move(m));
  }
  return black_;
}

ImportedValue Materials::color(const Parameters& p, std::string_view name, float fallback) {
  const TexturedValue value = textures_.value(p, name, Rgb(fallback));
  if (value.vertex_colors) {
    context_.note(p.element(), "left out", "vertex colours are read as a diffuse colour only");
  }
  return value.value;
}

double Materials::number(const Parameters& p, std::string_view name, double fallback) {
  if (!p.has(name)) return fallback;
  const ImportedValue value = color(p, name, 0);
  if (!value.texture) return grey_of(value.value);
  const double mean = grey_of(value.value) / 2;
  context_.note(p.element(), "approximated",
                fmt::format("{} stands for the texture of its {}", mean, name));
  return mean;
}

void Materials::read_diffuse_color(const Parameters& p, std::string_view name, float fallback,
                                   ImportedMaterial& m) {
  const TexturedValue value = textures_.value(p, name, Rgb(fallback));
  m.diffuse = value.value;
  m.vertex_colors = value.vertex_colors;
}

double Materials::index(const Parameters& p, std::string_view name, double fallback) {
  if (!p.has(name)) return fallback;
  const std::string text = p.text(name, "");
  if (const auto known = dielectric_index(text)) return *known;
  if (!text.empty() && std::isalpha(static_cast<unsigned char>(text[0])) != 0) {
    p.element().fail(fmt::format("has the material {}, whose index of refraction is not known",
                                 in_quotes(text)));
  }
  const double value = p.number(name, fallback);
  if (!(value > 0)) p.element().fail("has an index of refraction that is not above 0");
  return value;
}

double Materials::relative_index(const Parameters& p, double inside) {
  // `eta` is Mitsuba 0.6's short form of the ratio.
  if (p.has("eta")) return index(p, "eta", inside);
  return index(p, "intior", inside) / index(p, "extior", air);
}

void Materials::read_facets(const Parameters& p, ImportedMaterial& m, bool rough) {
  if (!rough) return;
  const std::string distribution = p.text("distribution", "beckmann");
  m.beckmann = distribution == "beckmann" || distribution == "phong" || distribution == "as";
  if (!m.beckmann && distribution != "ggx") {
    p.element().fail(fmt::format("has the distribution {}; allowed: beckmann, ggx, phong, as",
                                 in_quotes(distribution)));
  }
  if (distribution == "phong" || distribution == "as") {
    context_.note(p.element(), "approximated",
                  fmt::format("facets of the distribution {} become Beckmann's of the same alpha",
                              distribution));
  }
  p.ignore({"samplevisible"});
  const TexturedValue alpha = textures_.value(p, "alpha", Rgb(.1F));
  const double both = grey_of(alpha.value.value);
  m.alpha = {both, both};
  m.alpha_texture = alpha.value.texture;
  for (const int i : {0, 1}) {
    const char* name = i == 0 ? "alphau" : "alphav";
    if (!p.has(name)) continue;
    const TexturedValue along = textures_.value(p, name, Rgb(.1F));
    m.alpha[static_cast<std::size_t>(i)] = grey_of(along.value.value);
    if (along.value.texture) m.alpha_texture = along.value.texture;
  }
  for (double& a : m.alpha) {
    if (!(a >= 0)) p.element().fail("has a negative alpha");
    if (a > 1) {
      context_.note(p.element(), "approximated", fmt::format("its alpha {} is taken as 1", a));
      a = 1;
    }
  }
}

void Materials::read_diffuse(const Parameters& p, ImportedMaterial& m) {
  read_diffuse_color(p, p.has("diffusereflectance") ? "diffusereflectance" : "reflectance", .5F, m);
  if (p.element().type() != "roughdiffuse") return;
  const ImportedValue alpha = color(p, "alpha", .2F);
  if (alpha.texture) {
    context_.note(p.element(), "left out", "the texture of its alpha");
  }
  m.sigma = grey_of(alpha.value) / std::numbers::sqrt2;
  if (p.boolean("usefastapprox", false)) {
    context_.note(p.element(), "approximated",
                  "Oren and Nayar's full form stands for their fast approximation");
  }
}

void Materials::read_diffuse_transmission(const Parameters& p, ImportedMaterial& m) {
  m.type = ImportedMaterial::Type::diffuse_transmission;
  m.one_sided = false;
  m.transmittance = color(p, "transmittance", .5F);
}

void Materials::read_conductor(const Parameters& p, ImportedMaterial& m) {
  m.type = ImportedMaterial::Type::conductor;
  read_facets(p, m, p.element().type() == "roughconductor");
  m.reflectance = color(p, "specularreflectance", 1);
  const std::string name = p.text("material", "Cu");
  if (name == "none") {
    m.eta = Rgb(0);  // |r| = 1 whatever k
    m.k = Rgb(1);
  } else if (const auto metal = metal_index(name)) {
    m.eta = metal->eta;
    m.k = metal->k;
  } else if (!p.has("eta") || !p.has("k")) {
    p.element().fail(
        fmt::format("has the material {}, which is not known; allowed: names as Au, "
                    "Cu, Al, none, or eta and k",
                    in_quotes(name)));
  }
  if (p.has("eta")) m.eta = color(p, "eta", 0).value;
  if (p.has("k")) m.k = color(p, "k", 1).value;
  const auto outside = static_cast<float>(index(p, "exteta", air));
  m.eta /= outside;
  m.k /= outside;
}

void Materials::read_dielectric(const Parameters& p, ImportedMaterial& m) {
  const bool thin = p.element().type() == "thindielectric";
  m.type = thin ? ImportedMaterial::Type::thin_dielectric : ImportedMaterial::Type::dielectric;
  m.one_sided = false;
  m.ior = relative_index(p, bk7);
  read_facets(p, m, p.element().type() == "roughdielectric");
  m.reflectance = color(p, "specularreflectance", 1);
  m.transmittance = color(p, "speculartransmittance", 1);
  if (m.transmittance.texture) {
    context_.note(p.element(), "left out", "the texture of its specularTransmittance");
  }
}

void Materials::read_plastic(const Parameters& p, ImportedMaterial& m) {
  m.type = ImportedMaterial::Type::plastic;
  m.ior = relative_index(p, polypropylene);
  read_facets(p, m, p.element().type() != "plastic");
  read_diffuse_color(p, "diffusereflectance", .5F, m);
  m.reflectance = color(p, "specularreflectance", 1);
  m.nonlinear = p.boolean("nonlinear", false);
}

void Materials::read_phong(const Parameters& p, ImportedMaterial& m) {
  m.type = ImportedMaterial::Type::phong;
  read_diffuse_color(p, "diffusereflectance", .5F, m);
  m.reflectance = color(p, "specularreflectance", .2F);
  const ImportedValue exponent = color(p, "exponent", 30);
  if (exponent.texture) context_.note(p.element(), "left out", "the texture of its exponent");
  m.exponent = grey_of(exponent.value);
  if (!(m.exponent >= 0)) p.element().fail("has a negative exponent");
}

void Materials::read_ward(const Parameters& p, ImportedMaterial& m) {
  m.type = ImportedMaterial::Type::ward;
  read_diffuse_color(p, "diffusereflectance", .5F, m);
  m.reflectance = color(p, "specularreflectance", .2F);
  const std::string variant = p.text("variant", "balanced");
  if (variant != "ward" && variant != "ward-duer" && variant != "balanced") {
    p.element().fail(
        fmt::format("has the variant {}; allowed: ward, ward-duer, balanced", in_quotes(variant)));
  }
  m.ward_variant = variant == "ward-duer" ? "duer" : variant;
  m.alpha = {p.number("alphau", p.number("alpha", .1)), p.number("alphav", p.number("alpha", .1))};
  for (const double a : m.alpha) {
    if (!(a > 0 && a <= 1)) p.element().fail("allowed: alpha above 0, at most 1");
  }
}

void Materials::read_principled(const Parameters& p, ImportedMaterial& m) {
  m.type = ImportedMaterial::Type::standard;
  m.one_sided = false;
  read_diffuse_color(p, "basecolor", .5F, m);
  const ImportedValue roughness = color(p, "roughness", .5F), metallic = color(p, "metallic", 0);
  m.roughness = grey_of(roughness.value);
  m.metallic = grey_of(metallic.value);
  m.roughness_texture = roughness.texture;
  m.metallic_texture = metallic.texture;
  m.anisotropy = std::sqrt(std::clamp(number(p, "anisotropic", 0), 0.0, 1.0));
  m.transmission = number(p, "spectrans", 0);
  m.coat = number(p, "clearcoat", 0);
  m.coat_roughness =
      std::sqrt(.1 + (.001 - .1) * std::clamp(number(p, "clearcoatgloss", 0), 0.0, 1.0));
  m.sheen = Rgb(static_cast<float>(number(p, "sheen", 0)));
  if (p.has("eta")) {
    m.ior = index(p, "eta", 1.5);
  } else {
    // specular = .5 is eta = 1.5: r0 = .08 specular (Burley 2012).
    const double r = std::sqrt(.08 * std::clamp(number(p, "specular", .5), 0.0, 1.0));
    m.ior = (1 + r) / (1 - r);
  }
  for (double* unit : {&m.roughness, &m.metallic, &m.transmission, &m.coat, &m.coat_roughness}) {
    *unit = std::clamp(*unit, 0.0, 1.0);
  }
  for (const char* unread : {"spectint", "flatness", "difftrans"}) {
    if (number(p, unread, 0) != 0) {
      context_.note(p.element(), "left out", fmt::format("its {}", unread));
    }
  }
  if (m.sheen == Rgb(0)) p.ignore({"sheentint"});
  context_.note(p.element(), "approximated", "the nearest metallic-roughness material");
}

void Materials::read_thin_principled(const Parameters& p, ImportedMaterial& m) {
  read_principled(p, m);
  m.thin = true;
}

void Materials::read_null(const Parameters&, ImportedMaterial& m) {
  m.one_sided = false;
  m.diffuse = {{0, 0, 0}, nullptr};
  m.opacity.value = Rgb(0);
}

/// A filter of polarised light: unpolarised light passes through it.
void Materials::read_filter(const Parameters& p, ImportedMaterial& m) {
  read_null(p, m);
  p.ignore_all();
  context_.note(p.element(), "left out", "light has no polarisation");
}

/// What the BSDF says of its colour, or the one BSDF within it.
void Materials::read_other(const Parameters& p, ImportedMaterial& m) {
  const auto parts = p.objects("bsdf");
  if (parts.size() == 1) {
    m = *of(*parts[0]);
  } else {
    for (const char* name : {"reflectance", "diffusereflectance", "basecolor", "color"}) {
      if (p.has(name)) read_diffuse_color(p, name, .5F, m);
    }
  }
  p.ignore_all();
  context_.note(
      p.element(), "approximated",
      parts.size() == 1 ? "the BSDF within it stands for it" : "a diffuse BSDF stands for it");
}

}  // namespace lacuna::mitsuba
