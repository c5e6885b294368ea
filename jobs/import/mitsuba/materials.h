#pragma once

#include <map>
#include <memory>

#include "jobs/import/mitsuba/read_context.h"
#include "jobs/import/mitsuba/textures.h"

namespace lacuna::mitsuba {

/// Reads BSDFs, each once.
class Materials {
 public:
  Materials(ReadContext& context, Textures& textures) : context_(context), textures_(textures) {}

  using Pointer = std::shared_ptr<const ImportedMaterial>;
  /// Another one stands for a BSDF that is not read, with a note. Throws SceneError for BSDFs
  /// within themselves.
  Pointer of(const SceneElement& bsdf);
  /// That of a shape without one.
  Pointer fallback();
  /// That of an emitter without one.
  Pointer black();

 private:
  using Read = void (Materials::*)(const Parameters&, ImportedMaterial&);
  static Read reader_of(const std::string& type);

  void read_diffuse(const Parameters& p, ImportedMaterial& m);
  void read_diffuse_transmission(const Parameters& p, ImportedMaterial& m);
  void read_conductor(const Parameters& p, ImportedMaterial& m);
  void read_dielectric(const Parameters& p, ImportedMaterial& m);
  void read_plastic(const Parameters& p, ImportedMaterial& m);
  void read_phong(const Parameters& p, ImportedMaterial& m);
  void read_ward(const Parameters& p, ImportedMaterial& m);
  void read_principled(const Parameters& p, ImportedMaterial& m);
  void read_thin_principled(const Parameters& p, ImportedMaterial& m);
  void read_null(const Parameters& p, ImportedMaterial& m);
  void read_filter(const Parameters& p, ImportedMaterial& m);
  void read_other(const Parameters& p, ImportedMaterial& m);
  // Of others, material_wrappers.cpp.
  void read_two_sided(const Parameters& p, ImportedMaterial& m);
  void read_mask(const Parameters& p, ImportedMaterial& m);
  void read_blend(const Parameters& p, ImportedMaterial& m);
  void read_mixture(const Parameters& p, ImportedMaterial& m);
  void read_coating(const Parameters& p, ImportedMaterial& m);
  void read_bump_map(const Parameters& p, ImportedMaterial& m);
  void read_normal_map(const Parameters& p, ImportedMaterial& m);

  void read_facets(const Parameters& p, ImportedMaterial& m, bool rough);
  double index(const Parameters& p, std::string_view name, double fallback);
  double relative_index(const Parameters& p, double inside);
  void read_diffuse_color(const Parameters& p, std::string_view name, float fallback,
                          ImportedMaterial& m);
  ImportedValue color(const Parameters& p, std::string_view name, float fallback);
  /// A number whose texture, if it has one, is not read: half of it stands for that.
  double number(const Parameters& p, std::string_view name, double fallback);
  /// The BSDFs within, at least `least` and at most `most`.
  std::vector<Pointer> inner(const Parameters& p, std::size_t least, std::size_t most);
  /// The texture within a bumpmap or normalmap.
  ImportedValue map_within(const Parameters& p);

  ReadContext& context_;
  Textures& textures_;
  std::map<const SceneElement*, Pointer> known_;
  std::vector<const SceneElement*> open_;
  Pointer fallback_, black_;
};

}  // namespace lacuna::mitsuba
