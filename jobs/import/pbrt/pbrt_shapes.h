#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>

#include "jobs/import/pbrt/pbrt_context.h"

namespace lacuna::pbrt {

/// A shape in the coordinates of its statement.
struct Geometry {
  std::shared_ptr<const ImportedMesh> mesh;
  M44d to_object;        ///< of a mesh that several shapes share
  bool flipped = false;  ///< the front is where the triangles are clockwise
};

/// Reads `Shape` statements. Equal spheres, disks and cylinders, and equal PLY files share a mesh.
class ShapeReader {
 public:
  static constexpr std::size_t max_triangles = std::size_t{1} << 27;  // of all meshes together

  explicit ShapeReader(Context& context) : context_(context) {}

  /// None if the shape is left out, with a note. `reversed` is the state of ReverseOrientation.
  /// Throws SceneError for unknown types.
  std::optional<Geometry> read(const std::string& type, const Parameters& parameters,
                               bool reversed);

 private:
  using Mesh = std::shared_ptr<const ImportedMesh>;

  std::optional<Geometry> turned(const std::string& type, const Parameters& p);
  Mesh triangle_mesh(const Parameters& p);
  Mesh ply(const Parameters& p);
  template <class Make>
  Mesh shared(const std::string& key, const Place& place, Make&& make);

  Context& context_;
  void count(const ImportedMesh& mesh, const Place& place);

  std::map<std::string, Mesh> meshes_;
  std::size_t triangles_ = 0;
};

/// Whether u, v and the front's normal are a left-handed frame on most of the mesh. pbrt-v4's
/// second axis of normal maps is n x dp/du, glTF's follows v.
bool has_mirrored_uvs(const ImportedMesh& mesh, bool flipped);

/// Smallest, largest and total area of the triangles behind the transform.
struct Areas {
  double least = 0, most = 0, total = 0;
};
Areas areas_of(const ImportedMesh& mesh, const M44d& to_world);

/// Positions, normals and texture coordinates of a mesh by the names of parameters. Throws
/// SceneError if their counts differ.
void read_vertices(const Parameters& p, ImportedMesh& mesh);

}  // namespace lacuna::pbrt
