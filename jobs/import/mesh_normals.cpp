#include "jobs/import/mesh_normals.h"

#include <algorithm>
#include <cmath>

namespace lacuna {

void add_smooth_normals(ImportedMesh& mesh) {
  std::vector<V3d> sums(mesh.positions.size(), V3d(0));
  for (const auto& t : mesh.triangles) {
    std::array<V3d, 3> p;
    for (std::size_t k = 0; k < 3; ++k) p[k] = V3d(mesh.positions[t[k]]);
    const V3d n = (p[1] - p[0]).cross(p[2] - p[0]).normalized();
    for (std::size_t k = 0; k < 3; ++k) {
      const V3d a = (p[(k + 1) % 3] - p[k]).normalized(), b = (p[(k + 2) % 3] - p[k]).normalized();
      sums[t[k]] += n * std::acos(std::clamp(a.dot(b), -1.0, 1.0));
    }
  }
  mesh.normals.clear();
  for (const V3d& n : sums) {
    mesh.normals.push_back(n.length() > 0 ? V3f(n.normalized()) : V3f(0, 0, 1));
  }
}

std::vector<V3f> unit_normals(const ImportedMesh& mesh) {
  std::vector<V3f> out = mesh.normals;
  ImportedMesh smooth;
  for (std::size_t i = 0; i < out.size(); ++i) {
    const float length = out[i].length();
    if (length > 0 && std::isfinite(length)) {
      out[i] /= length;
      continue;
    }
    if (smooth.normals.empty()) {
      smooth.positions = mesh.positions;
      smooth.triangles = mesh.triangles;
      add_smooth_normals(smooth);
    }
    out[i] = smooth.normals[i];
  }
  return out;
}

void orient_by_normals(ImportedMesh& mesh) {
  if (mesh.normals.empty()) return;
  for (auto& t : mesh.triangles) {
    const V3f &a = mesh.positions[t[0]], &b = mesh.positions[t[1]], &c = mesh.positions[t[2]];
    const V3f sum = mesh.normals[t[0]] + mesh.normals[t[1]] + mesh.normals[t[2]];
    if ((b - a).cross(c - a).dot(sum) < 0) std::swap(t[1], t[2]);
  }
}

}  // namespace lacuna
