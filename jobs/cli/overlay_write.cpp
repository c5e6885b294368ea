#include "base/storage/atomic_file.h"
#include "jobs/cli/overlay.h"
#include "jobs/import/glb_document.h"
#include "renderer/scene/scene_shape.h"

namespace lacuna {
namespace {

/// Returns its index.
std::size_t add_overlay_mesh(GlbDocument& document, const OverlayMesh& mesh, float alpha) {
  OrderedJson material = {
      {"name", mesh.name},
      {"doubleSided", true},
      {"pbrMetallicRoughness",
       {{"baseColorFactor", {mesh.colour.x, mesh.colour.y, mesh.colour.z, alpha}},
        {"metallicFactor", 0}}}};
  if (alpha < 1) material["alphaMode"] = "BLEND";
  const std::size_t index = document.add("materials", material);
  return document.add("meshes",
                      {{"name", mesh.name},
                       {"primitives",
                        {{{"attributes", {{"POSITION", document.add_positions(mesh.positions)}}},
                          {"indices", document.add_triangles(mesh.triangles)},
                          {"material", index}}}}});
}

M44d matrix_of(const TriangleSoup::Placement& placement) {
  M44d m;
  for (int k = 0; k < 3; ++k) {
    for (int axis = 0; axis < 3; ++axis) m[axis][k] = double(placement.axes[std::size_t(axis)][k]);
    m[3][k] = double(placement.at[k]);
  }
  return m;
}

}  // namespace

void write_overlay(const std::filesystem::path& file, const SceneData& scene,
                   const std::vector<OverlayMesh>& overlay) {
  GlbDocument document("lacuna analyze");
  // Positions are relative to the scene's origin.
  const std::size_t root =
      document.add_node({{"name", "origin"}, {"translation", gltf_vector(scene.origin)}});
  const auto place = [&](const OverlayMesh& mesh, float alpha) {
    if (mesh.triangles.empty()) return;
    document.add_node({{"name", mesh.name}, {"mesh", add_overlay_mesh(document, mesh, alpha)}},
                      root);
  };
  TriangleSoup soup = triangle_soup(scene);
  constexpr float grey = 0.6F, see_through = 0.25F;
  place({"scene", Rgb(grey), std::move(soup.positions), std::move(soup.triangles)}, see_through);
  std::vector<std::size_t> prototypes;
  for (auto& p : soup.prototypes) {
    prototypes.push_back(add_overlay_mesh(
        document, {"scene", Rgb(grey), std::move(p.positions), std::move(p.triangles)},
        see_through));
  }
  for (const auto& placement : soup.placements) {
    document.add_node(
        {{"mesh", prototypes[placement.prototype]}, {"matrix", gltf_matrix(matrix_of(placement))}},
        root);
  }
  for (const OverlayMesh& mesh : overlay) place(mesh, 1);
  for (const CameraData& camera : scene.cameras) {
    const std::size_t index =
        document.add("cameras", {{"type", "perspective"},
                                 {"name", camera.name},
                                 {"perspective", {{"yfov", camera.yfov}, {"znear", 0.01}}}});
    document.add_node(
        {{"name", camera.name}, {"camera", index}, {"matrix", gltf_matrix(camera.to_world)}}, root);
  }
  write_file_atomically(file, document.glb());
}

}  // namespace lacuna
