#include "jobs/import/pbrt/pbrt_version.h"

#include <algorithm>
#include <array>

namespace lacuna::pbrt {
namespace {

template <std::size_t N>
bool contains(const std::array<std::string_view, N>& names, std::string_view name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

constexpr std::array<std::string_view, 11> v3_materials{
    "matte", "plastic",     "uber",   "substrate",    "metal",  "mirror",
    "glass", "translucent", "disney", "kdsubsurface", "fourier"};
constexpr std::array<std::string_view, 9> v4_materials{
    "diffuse",        "coateddiffuse",       "conductor", "coatedconductor", "dielectric",
    "thindielectric", "diffusetransmission", "interface", "measured"};

std::optional<Version> of_film(std::string_view type) {
  if (type == "image") return Version::v3;
  if (type == "rgb" || type == "gbuffer" || type == "spectral") return Version::v4;
  return {};
}

std::optional<Version> of_material(std::string_view type) {
  if (contains(v3_materials, type)) return Version::v3;
  if (contains(v4_materials, type)) return Version::v4;
  return {};
}

}  // namespace

std::optional<Version> find_version(const std::filesystem::path& file) {
  const Context context(file, Version::v4);  // for the paths of includes
  Tokens tokens(file);
  std::string_view statement;
  int texts = 0;         // since the statement
  bool is_type = false;  // of a material: the value after "string type"
  while (const auto token = tokens.next()) {
    if (token->kind == Token::Kind::word && !number_of(token->text)) {
      statement = token->text;
      texts = 0;
      if (contains<4>({"Option", "ColorSpace", "Attribute", "Import"}, statement))
        return Version::v4;
      if (statement == "WorldEnd") return Version::v3;
    }
    if (token->kind != Token::Kind::text) continue;
    ++texts;
    if (statement == "Include" && texts == 1) {
      const auto included = context.resolve(std::string(token->text), token->place);
      std::error_code none;
      if (std::filesystem::is_regular_file(included, none)) tokens.include(included, token->place);
    }
    std::optional<Version> found;
    if (statement == "Film" && texts == 1) found = of_film(token->text);
    if ((statement == "Material" && texts == 1) || (statement == "MakeNamedMaterial" && is_type)) {
      found = of_material(token->text);
    }
    if (statement == "Texture" && texts == 2 && token->text == "color") found = Version::v3;
    if (found) return found;
    is_type = token->text == "string type";
  }
  return {};
}

}  // namespace lacuna::pbrt
