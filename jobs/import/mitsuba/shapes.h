#pragma once

#include <map>
#include <memory>
#include <set>
#include <string>
#include <tuple>
#include <vector>

#include "jobs/import/mitsuba/materials.h"
#include "jobs/import/mitsuba/read_context.h"

namespace lacuna::mitsuba {

/// Reads shapes.
class Shapes {
 public:
  Shapes(ReadContext& context, Textures& textures, Materials& materials, ImportedScene& scene)
      : context_(context), textures_(textures), materials_(materials), scene_(scene) {}

  /// Adds a shape, or the shapes of a group under an instance, to the scene.
  void add(const SceneElement& shape, const M44d& to_parent = {});

 private:
  using MeshPointer = std::shared_ptr<const ImportedMesh>;
  /// The triangles of one material of an OBJ; a whole mesh of another kind, with an empty name.
  struct Part {
    std::string material;
    MeshPointer mesh;
  };
  struct Read {
    std::vector<Part> parts;
    M44d placing;                          ///< before the shape's toWorld
    std::vector<std::string> libraries{};  ///< of an OBJ, as paths from the scene's folder
  };

  void add_group(const SceneElement& group, const M44d& to_parent);
  void add_instance(const Parameters& p, const M44d& to_parent);
  Read read(const Parameters& p);
  Read read_sphere(const Parameters& p);
  Read read_cylinder(const Parameters& p);
  Read load(const Parameters& p, const std::string& kind);
  MeshPointer unit_mesh(const std::string& type);
  /// The BSDFs of the parts; null: that of a shape without one.
  std::vector<const SceneElement*> bsdfs_of(const Parameters& p, const Read& read);
  const std::map<std::string, SceneElement>& library(const SceneElement& at,
                                                     const std::string& name);
  std::shared_ptr<const ImportedMaterial> with_interior(
      const Parameters& p, const std::shared_ptr<const ImportedMaterial>& material);
  void note_rounded(const Parameters& p, const std::string& type);

  ReadContext& context_;
  Textures& textures_;
  Materials& materials_;
  ImportedScene& scene_;
  std::map<std::string, MeshPointer> units_;
  std::map<std::string, Read> files_;  // by everything that the meshes depend on
  std::map<std::string, std::map<std::string, SceneElement>> libraries_;  // of MTL, by path
  std::map<const ImportedMesh*, MeshPointer> plain_;                      // without their colours
  std::map<std::pair<const ImportedMaterial*, const SceneElement*>,
           std::shared_ptr<const ImportedMaterial>>
      filled_;
  std::set<const ImportedMesh*> wound_;  // their front follows from the triangles alone
  std::set<std::string> noted_;
  std::size_t added_ = 0;
  std::vector<const SceneElement*> open_;
};

}  // namespace lacuna::mitsuba
