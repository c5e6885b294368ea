#include "renderer/geometry/tangent_frame.h"

namespace lacuna {
namespace {

std::optional<TextureDirections> of_file(const Mesh& mesh, std::uint32_t triangle, const V2f& at) {
  if (mesh.tangents.empty()) return std::nullopt;
  const V4f t = mesh.mix(mesh.tangents, triangle, at);
  const V3d along(t.x, t.y, t.z);
  return TextureDirections{along, V3d(mesh.mix(mesh.normals, triangle, at)).cross(along) *
                                      std::copysign(1.0, double(t.w))};
}

/// dx/du and -dx/dv of the linear map from texture coordinates to positions.
std::optional<TextureDirections> of_coordinates(const Mesh& mesh, std::uint32_t triangle,
                                                const TextureRef& texture) {
  const auto& uvs = mesh.uvs[static_cast<std::size_t>(texture.uv_set)];
  if (uvs.empty()) return std::nullopt;
  const auto& t = mesh.triangles[triangle];
  const auto uv = [&](std::size_t k) { return texture.transform(uvs[t[k]]); };
  const auto x = [&](std::size_t k) { return V3d(mesh.positions[t[k]]); };
  const V2f p = uv(0), q = uv(1), r = uv(2);
  const double u1 = double(q.x) - double(p.x), v1 = double(q.y) - double(p.y);
  const double u2 = double(r.x) - double(p.x), v2 = double(r.y) - double(p.y);
  const double area = u1 * v2 - u2 * v1;
  if (area == 0) return std::nullopt;
  const V3d e1 = x(1) - x(0), e2 = x(2) - x(0);
  return TextureDirections{(e1 * v2 - e2 * v1) / area, (e1 * u2 - e2 * u1) / area};
}

/// `d` of the triangle of `at_hit`, in scene coordinates.
TextureDirections placed(const SceneData& scene, const Surface& at_hit,
                         const TextureDirections& d) {
  if (at_hit.instance == no_instance) return d;
  const auto& a = scene.instances[at_hit.instance].axes;
  const auto direction = [&](const V3d& w) {
    return V3d(a[0]) * w.x + V3d(a[1]) * w.y + V3d(a[2]) * w.z;
  };
  return {direction(d.along), direction(d.up)};
}

}  // namespace

std::optional<TextureDirections> texture_directions(const SceneData& scene, const Surface& at_hit,
                                                    const TextureRef& texture) {
  const auto d = of_coordinates(scene.meshes[at_hit.mesh], at_hit.triangle, texture);
  if (!d) return std::nullopt;
  return placed(scene, at_hit, *d);
}

std::optional<TangentFrame> tangent_frame(const SceneData& scene, const Surface& at_hit,
                                          const V2f& at, const TextureRef& texture) {
  const Mesh& mesh = scene.meshes[at_hit.mesh];
  auto d = of_file(mesh, at_hit.triangle, at);
  if (!d) d = of_coordinates(mesh, at_hit.triangle, texture);
  if (!d) return std::nullopt;
  d = placed(scene, at_hit, *d);
  const V3d normal(at_hit.ns);
  const V3d along = d->along.normalized();
  const V3d across = along - normal * normal.dot(along);
  constexpr double cancelled = 1e-6;  // what rounding leaves of 0
  if (!(across.length() > cancelled)) return std::nullopt;
  TangentFrame frame;
  frame.s = V3f(across.normalized());
  frame.n = at_hit.ns;
  frame.t = cross(frame.n, frame.s);
  if (V3d(frame.t).dot(d->up) < 0) frame.t = -frame.t;
  return frame;
}

}  // namespace lacuna
