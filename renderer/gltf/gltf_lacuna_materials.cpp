#include "renderer/gltf/gltf_lacuna_materials.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

namespace lacuna::gltf {
namespace {

using Type = LacunaMaterial::Type;
constexpr std::string_view extension_name = "LACUNA_materials";

/// A "type", and the members that only some types have.
struct TypeRow {
  std::string_view name;
  Type type;
  std::vector<std::string_view> members;
};
const std::vector<TypeRow>& type_rows() {
  static const std::vector<TypeRow> rows{
      {"diffuse", Type::diffuse, {"oneSided", "sigma"}},
      {"conductor",
       Type::conductor,
       {"oneSided", "distribution", "masking", "alpha", "alphaTexture", "eta", "k", "reflectance",
        "reflectanceTexture"}},
      {"dielectric",
       Type::dielectric,
       {"distribution", "masking", "alpha", "alphaTexture", "ior", "reflectance", "transmittance"}},
      {"thinDielectric", Type::thin_dielectric, {"ior", "reflectance", "transmittance"}},
      {"plastic",
       Type::plastic,
       {"oneSided", "distribution", "masking", "alpha", "alphaTexture", "ior", "nonlinear",
        "reflectance"}},
      {"phong", Type::glossy, {"oneSided", "reflectance", "reflectanceTexture", "exponent"}},
      {"ward", Type::glossy, {"oneSided", "reflectance", "reflectanceTexture", "alpha", "variant"}},
      {"coating",
       Type::coating,
       {"oneSided", "base", "ior", "thickness", "absorption", "alpha", "alphaTexture",
        "distribution", "masking", "reflectance"}},
      {"mixture", Type::mixture, {"oneSided", "parts", "weightTexture"}},
  };
  return rows;
}

const TypeRow& row_of(const GltfObject& in) {
  const std::string name = in.string("type");
  const auto found = std::ranges::find(type_rows(), name, &TypeRow::name);
  if (found != type_rows().end()) return *found;
  std::vector<std::string> names;
  for (const TypeRow& r : type_rows()) names.push_back(fmt::format("\"{}\"", r.name));
  in.refuse("type", fmt::format("{}", fmt::join(names, ", ")));
}

/// The members of one material.
struct LacunaReader {
  const GltfObject& in;
  TextureTable& textures;
  const TypeRow& row;

  bool may_have(std::string_view member) const {
    return std::ranges::find(row.members, member) != row.members.end();
  }
  void refuse_unknown() const {
    for (const std::string& key : in.keys()) {
      if (key == "type" || key == "bump" || key == "extras" || may_have(key)) continue;
      in.fail(fmt::format("unknown member \"{}\"; \"{}\" has bump, {}", key, row.name,
                          fmt::join(row.members, ", ")));
    }
  }

  float number(std::string_view key, double fallback, const Limits& allowed) const {
    return static_cast<float>(in.number(key, fallback, allowed));
  }
  Rgb colour(std::string_view key, const Rgb& fallback, const Limits& allowed) const {
    const auto c = in.numbers<3>(key, allowed);
    if (!c) return fallback;
    return {static_cast<float>((*c)[0]), static_cast<float>((*c)[1]), static_cast<float>((*c)[2])};
  }
  Rgb required_colour(std::string_view key) const {
    if (!in.has(key)) in.fail(fmt::format("{} is missing: three numbers, at least 0", key));
    return colour(key, Rgb(0, 0, 0), non_negative);
  }

  /// "alpha": one number, or two.
  V2f alpha() const {
    if (!in.has("alpha")) return {0, 0};
    const std::vector<double> a = in.one_or_more("alpha", unit_interval);
    if (a.size() > 2 || a.empty()) in.refuse("alpha", "a number, or two: along u and across");
    return {static_cast<float>(a.front()), static_cast<float>(a.back())};
  }
  FacetShape shape() const {
    if (row.name == "phong") return FacetShape::phong;
    if (row.name == "ward") {
      const std::string variant = in.string("variant", "balanced");
      if (variant == "ward") return FacetShape::ward;
      if (variant == "duer") return FacetShape::ward_duer;
      if (variant != "balanced") in.refuse("variant", "\"ward\", \"duer\" or \"balanced\"");
      return FacetShape::ward_balanced;
    }
    const std::string name = in.string("distribution", "ggx");
    if (name != "ggx" && name != "beckmann") in.refuse("distribution", "\"ggx\" or \"beckmann\"");
    const std::string masking = in.string("masking", "separable");
    if (masking != "separable" && masking != "correlated") {
      in.refuse("masking", "\"separable\" or \"correlated\"");
    }
    if (name == "ggx") {
      return masking == "correlated" ? FacetShape::ggx : FacetShape::ggx_separable;
    }
    if (masking == "correlated") in.refuse("masking", "\"separable\", with Beckmann's facets");
    return FacetShape::beckmann;
  }

  void read(LacunaMaterial& out) const {
    refuse_unknown();
    out.type = row.type;
    out.one_sided = in.boolean("oneSided", false);
    out.nonlinear = in.boolean("nonlinear", false);
    out.sigma = number("sigma", 0, non_negative);
    out.shape = shape();
    out.alpha = alpha();
    if (out.shape == FacetShape::phong) {
      const float exponent = number("exponent", 0, non_negative);
      if (!(exponent <= 1e7F)) in.refuse("exponent", "a number from 0 to 1e7");
      const float width = std::sqrt(2 / (exponent + 2));
      out.alpha = {width, width};
    }
    out.alpha_texture =
        textures.reference(in, "alphaTexture", Texture::Encoding::linear, out.alpha.length2() > 0);
    if (may_have("ior")) {
      out.ior = static_cast<float>(in.number("ior", non_negative));
      if (!(out.ior >= 1e-3F && out.ior <= 1e3F)) in.refuse("ior", "a number from 0.001 to 1000");
    }
    if (row.type == Type::conductor) {
      out.eta = required_colour("eta");
      out.k = required_colour("k");
    }
    const Rgb white(1, 1, 1);
    out.reflectance = colour("reflectance", white, unit_interval);
    out.reflectance_texture =
        textures.reference(in, "reflectanceTexture", Texture::Encoding::srgb, true);
    out.transmittance = colour("transmittance", white, unit_interval);
    out.optical_depth =
        number("thickness", 1, non_negative) * colour("absorption", {0, 0, 0}, non_negative);
    if (!is_finite(out.optical_depth)) in.fail("thickness times absorption is too large");
    out.weight_texture = textures.reference(in, "weightTexture", Texture::Encoding::linear, true);
    if (const auto bump = in.object("bump")) {
      out.bump_scale = static_cast<float>(bump->number("scale", 1, any_float));
      out.bump = textures.reference(in, "bump", Texture::Encoding::linear, out.bump_scale != 0);
    }
  }
};

/// Fills in the parts of mixtures and coatings: copies of the materials that they name.
class PartTable {
 public:
  PartTable(const std::vector<GltfObject>& from, std::vector<Material>& materials)
      : from_(from), materials_(materials), sizes_(from.size()) {}

  /// How many materials a material is made of, and how deep.
  struct Size {
    std::size_t count = 1;
    int depth = 0;
    bool reading = false;
  };
  const Size& complete(std::size_t i) {
    Size& size = sizes_[i];
    const auto in = from_[i].extension(extension_name);
    if (size.reading) in->fail("it is a part of itself");
    if (!materials_[i].lacuna || !materials_[i].lacuna->parts.empty()) return size;
    size.reading = true;
    ++open_;
    LacunaMaterial& out = *materials_[i].lacuna;
    const auto add = [&](std::size_t part, const Rgb& weight) {
      if (open_ > deepest) in->fail(too_deep());
      const Size& of_part = complete(part);
      size.count += of_part.count;
      size.depth = std::max(size.depth, of_part.depth + 1);
      if (size.depth > deepest) in->fail(too_deep());
      if (size.count > most) in->fail(fmt::format("it has more than {} parts of parts", most));
      out.parts.push_back({std::make_shared<Material>(materials_[part]), weight});
    };
    if (out.type == Type::coating) {
      const auto base = in->index("base", materials_count(), "materials");
      if (!base) in->fail("base is missing: the index of a material");
      add(*base, Rgb(1, 1, 1));
      check_base(*in, *out.parts[0].material);
    }
    if (out.type == Type::mixture) read_mixture(*in, out, add);
    --open_;
    size.reading = false;
    return size;
  }

 private:
  static constexpr int deepest = 8;
  static constexpr std::size_t most = 256;
  static std::string too_deep() {
    return fmt::format("its parts have parts to a depth of more than {}", deepest);
  }
  std::size_t materials_count() const { return from_.size(); }

  template <class Add>
  void read_mixture(const GltfObject& in, const LacunaMaterial& out, Add&& add) const {
    const std::vector<GltfObject> parts = in.objects("parts");
    if (parts.size() < 2) in.fail("parts: two or more are needed");
    if (out.weight_texture.used() && parts.size() != 2) {
      in.fail("weightTexture: allowed with two parts only");
    }
    Rgb sum(0, 0, 0);
    for (const GltfObject& part : parts) {
      for (const std::string& key : part.keys()) {
        if (key != "material" && key != "weight") {
          part.fail(fmt::format("unknown member \"{}\"; a part has material, weight", key));
        }
      }
      const auto material = part.index("material", materials_count(), "materials");
      if (!material) part.fail("material is missing: the index of a material");
      const Rgb weight = weight_of(part, out.weight_texture.used());
      sum += weight;
      add(*material, weight);
    }
    constexpr float rounding = 1e-4F;
    if (!out.weight_texture.used() && max_component(sum) > 1 + rounding) {
      in.fail(fmt::format("the weights of its parts have the sum {}; allowed: up to 1",
                          max_component(sum)));
    }
  }
  static Rgb weight_of(const GltfObject& part, bool textured) {
    if (!part.has("weight")) {
      if (!textured) part.fail("weight is missing: a number from 0 to 1, or three");
      return {1, 1, 1};
    }
    const std::vector<double> w = part.one_or_more("weight", unit_interval);
    if (w.size() != 1 && w.size() != 3) part.refuse("weight", "a number from 0 to 1, or three");
    return {static_cast<float>(w.front()), static_cast<float>(w[w.size() / 2]),
            static_cast<float>(w.back())};
  }
  /// Light is refracted in a coating once: it lies over an opaque surface, not over another one.
  static void check_base(const GltfObject& in, const Material& base) {
    if (base.lacuna && base.lacuna->type == Type::mixture) {
      for (const LacunaMaterial::Part& p : base.lacuna->parts) check_base(in, *p.material);
      return;
    }
    const bool passes =
        base.lacuna ? base.lacuna->transmits()
                    : base.transmission > 0 || base.extensions.diffuse_transmission.factor > 0;
    if (passes) in.refuse("base", "a material that transmits no light");
    if (base.lacuna && base.lacuna->type == Type::coating) {
      in.refuse("base", "a material that is no coating itself");
    }
  }

  const std::vector<GltfObject>& from_;
  std::vector<Material>& materials_;
  std::vector<Size> sizes_;
  int open_ = 0;  // materials that are being read, one a part of the other
};

}  // namespace

void read_lacuna_materials(const GltfObject& root, TextureTable& textures,
                           std::vector<Material>& materials) {
  const std::vector<GltfObject> all = root.objects("materials");
  for (std::size_t i = 0; i < all.size(); ++i) {
    const auto in = all[i].extension(extension_name);
    if (!in || materials[i].unlit) continue;
    LacunaReader{*in, textures, row_of(*in)}.read(materials[i].lacuna.emplace());
  }
  PartTable parts(all, materials);
  for (std::size_t i = 0; i < all.size(); ++i) parts.complete(i);
}

}  // namespace lacuna::gltf
