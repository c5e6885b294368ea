#include "renderer/geometry/uv_tangents.h"

namespace lacuna {

std::array<V3f, 2> uv_tangents(const Mesh& mesh, std::uint32_t triangle, int uv_set) {
  const auto& t = mesh.triangles[triangle];
  const V3d a(mesh.positions[t[0]]);
  const V3d e1 = V3d(mesh.positions[t[1]]) - a, e2 = V3d(mesh.positions[t[2]]) - a;
  const auto fallback = [&] {
    return std::array{V3f(e1.normalized()), V3f(e1.cross(e2).cross(e1).normalized())};
  };
  const std::vector<V2f>& uvs = mesh.uvs[static_cast<std::size_t>(uv_set)];
  if (uvs.empty()) return fallback();
  const V2f d1 = uvs[t[1]] - uvs[t[0]], d2 = uvs[t[2]] - uvs[t[0]];
  // e = u dP/du + v dP/dv for both edges.
  const double det = double(d1.x) * double(d2.y) - double(d1.y) * double(d2.x);
  const V3d along_u = (e1 * double(d2.y) - e2 * double(d1.y)) * (det < 0 ? -1.0 : 1.0);
  const V3d along_v = (e2 * double(d1.x) - e1 * double(d2.x)) * (det < 0 ? -1.0 : 1.0);
  if (det == 0 || !(along_u.length() > 0) || !(along_v.length() > 0)) return fallback();
  return {V3f(along_u.normalized()), V3f(-along_v.normalized())};
}

}  // namespace lacuna
