#pragma once

#include <array>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "jobs/import/pbrt/pbrt_camera.h"
#include "jobs/import/pbrt/pbrt_context.h"
#include "jobs/import/pbrt/pbrt_media.h"
#include "jobs/import/pbrt/pbrt_shapes.h"
#include "jobs/import/pbrt/pbrt_transforms.h"

namespace lacuna::pbrt {

/// The statements of a scene file, one by one, and what they make.
class Reader {
 public:
  static constexpr std::size_t max_nesting = 256;                  // of attributes and transforms
  static constexpr std::size_t max_shapes = std::size_t{1} << 22;  // instances included

  Reader(const std::filesystem::path& file, Version version);

  /// Reads all of the file. Throws SceneError.
  void read();
  /// The scene, in right-handed coordinates. Only once, after read().
  ImportedScene finish();

  Context& context() { return context_; }

 private:
  /// A shape in pbrt's coordinates. Its material may be defined later.
  struct Shape {
    ImportedShape shape;
    Place place;
    std::shared_ptr<const MaterialEntry> material;
    std::optional<ImportedValue> alpha;
    std::shared_ptr<const Medium> inside;
  };
  struct State {
    CurrentTransform ctm;
    bool reversed = false;
    std::shared_ptr<const MaterialEntry> material;
    std::shared_ptr<const Statement> area_light;
    std::shared_ptr<const Medium> inside;
    ColourSpace colours = ColourSpace::srgb;
    std::map<std::string, std::shared_ptr<const Parameters>> defaults;  // of pbrt-v4's Attribute
  };
  enum class Scope { attribute, transform, object, import };
  struct Pushed {
    Scope scope;
    Place place;
    State state;
    std::vector<std::function<void(Names&)>> undo;  // of pbrt-v3's names, which end with the scope
  };

  void statement(const Token& word);
  bool scope_statement(std::string_view name, const Place& place);
  bool option_statement(std::string_view name, const Place& place);
  bool world_statement(std::string_view name, const Place& place);
  bool coordinate_statement(std::string_view name, const Place& place);

  void pixel_filter(const Statement& filter);
  void push(Scope scope, const Place& place);
  void pop(Scope scope, const Place& place);
  void include(const Place& place, bool import);
  void close_imports();
  void begin_world(const Place& place);
  void attribute(const Place& place);
  void named_medium(const Place& place);
  void medium_interface(const Place& place);

  Statement typed_statement(std::string_view name, const Place& place);
  std::string text(const Place& place, const char* what);
  void texture(const Place& place);
  void material(const Place& place);
  void make_named_material(const Place& place);
  void light(const Place& place);
  void shape(const Place& place);
  void begin_object(const Place& place);
  void end_object(const Place& place);
  void instance(const Place& place);

  void emit(Shape& out, const Parameters& parameters, bool of_triangles);
  void add(Shape shape, const Place& place);
  std::shared_ptr<const ImportedMaterial> material_of(const Shape& shape);
  void note_animation(const Place& place, const std::string& name);
  /// Of the current transform; notes that `name` is left out.
  bool lacks_inverse(const Place& place, const std::string& name);
  /// In pbrt-v3 the scope's end brings back what `name` is now.
  template <class Map>
  void define(Map Names::*map, const std::string& name);
  void add_defaults(Parameters& parameters, const char* target) const;

  Context context_;
  Tokens tokens_;
  ShapeReader shape_reader_;
  RenderOptions options_;
  ImportedScene scene_;
  State state_;
  std::vector<Pushed> pushed_;
  std::vector<std::size_t> imports_;  // depths of tokens_ before the files of Import
  std::map<std::string, M44d> coordinate_systems_;
  std::vector<Shape> shapes_;
  std::map<std::string, std::vector<Shape>> objects_;
  std::optional<std::string> open_object_;
  bool in_world_ = false, ended_ = false;
  std::map<std::string, std::shared_ptr<const Medium>> media_;
  // Materials with the opacity of shapes: by material, texture and value.
  std::map<std::tuple<const ImportedMaterial*, const ImportedTexture*, float>,
           std::shared_ptr<const ImportedMaterial>>
      cut_out_;
  std::map<std::pair<const ImportedMaterial*, const Medium*>,
           std::shared_ptr<const ImportedMaterial>>
      filled_;
};

}  // namespace lacuna::pbrt
