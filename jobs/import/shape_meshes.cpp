#include "jobs/import/shape_meshes.h"

#include <algorithm>
#include <cmath>

namespace lacuna {
namespace {

/// The factor of a regular polygon's radius that gives it the area of the circle of radius 1.
double equal_area_radius(double angle) { return std::sqrt(angle / std::sin(angle)); }

double area_of(const ImportedMesh& mesh) {
  double area = 0;
  for (const auto& t : mesh.triangles) {
    const V3d a(mesh.positions[t[0]]), b(mesh.positions[t[1]]), c(mesh.positions[t[2]]);
    area += (b - a).cross(c - a).length() / 2;
  }
  return area;
}

void add_quad(ImportedMesh& mesh, std::uint32_t a, std::uint32_t b, std::uint32_t c,
              std::uint32_t d) {
  mesh.triangles.push_back({a, b, c});
  mesh.triangles.push_back({a, c, d});
}

}  // namespace

ImportedMesh revolution_mesh(const std::string& name, const std::vector<ProfilePoint>& profile,
                             double phi_max) {
  ImportedMesh mesh;
  mesh.name = name;
  const int segments = std::max(
      3, static_cast<int>(std::ceil(turn_segments * phi_max / (2 * std::numbers::pi) - 1e-9)));
  const double step = phi_max / segments, widen = equal_area_radius(step);
  const auto add = [&](const ProfilePoint& p, double at) {
    const double phi = step * at, c = std::cos(phi), s = std::sin(phi), r = p.radius * widen;
    mesh.positions.push_back(V3f(V3d(r * c, r * s, p.z)));
    mesh.normals.push_back(V3f(V3d(p.normal_radial * c, p.normal_radial * s, p.normal_z)));
    mesh.uvs.push_back(V2f(V2d(at / segments, p.v)));
  };
  // At a pole each segment has a vertex of its own, with the u of its middle.
  for (const ProfilePoint& p : profile) {
    for (int i = 0; i <= segments; ++i) add(p, p.radius == 0 ? i + .5 : i);
  }
  const auto row = static_cast<std::uint32_t>(segments + 1);
  for (std::uint32_t j = 0; j + 1 < profile.size(); ++j) {
    for (std::uint32_t i = 0; i < row - 1; ++i) {
      const std::uint32_t low = j * row + i, high = low + row;
      if (profile[j].radius != 0) mesh.triangles.push_back({low, low + 1, high + 1});
      if (profile[j + 1].radius != 0) mesh.triangles.push_back({low, high + 1, high});
      if (profile[j].radius == 0 && profile[j + 1].radius == 0) continue;
      // The other corner of a triangle at a pole is the vertex of this segment.
      if (profile[j + 1].radius == 0) mesh.triangles.back()[2] = high;
    }
  }
  return mesh;
}

ImportedMesh sphere_mesh(double z_min, double z_max, double phi_max) {
  const double from = std::acos(std::clamp(z_min, -1.0, 1.0)),
               to = std::acos(std::clamp(z_max, -1.0, 1.0));
  const int rows = std::max(
      2, static_cast<int>(std::ceil(turn_segments * (from - to) / std::numbers::pi - 1e-9)));
  std::vector<ProfilePoint> profile;
  for (int j = 0; j <= rows; ++j) {
    const double v = static_cast<double>(j) / rows, theta = from + (to - from) * v;
    const bool pole = (j == 0 && z_min <= -1) || (j == rows && z_max >= 1);
    const double r = pole ? 0 : std::sin(theta), z = std::cos(theta);
    profile.push_back({r, z, r, z, v});
  }
  ImportedMesh mesh = revolution_mesh("sphere", profile, phi_max);
  const bool whole = z_min <= -1 && z_max >= 1 && phi_max >= 2 * std::numbers::pi;
  if (whole) {
    const double scale = std::sqrt(4 * std::numbers::pi / area_of(mesh));
    for (V3f& p : mesh.positions) p *= static_cast<float>(scale);
  }
  return mesh;
}

ImportedMesh cylinder_mesh(double phi_max) {
  return revolution_mesh("cylinder", {{1, 0, 1, 0, 0}, {1, 1, 1, 0, 1}}, phi_max);
}

ImportedMesh disk_mesh(double inner_radius, double phi_max) {
  return revolution_mesh("disk", {{1, 0, 0, 1, 0}, {inner_radius, 0, 0, 1, 1}}, phi_max);
}

ImportedMesh rectangle_mesh() {
  ImportedMesh mesh;
  mesh.name = "rectangle";
  mesh.positions = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
  mesh.normals.assign(4, V3f(0, 0, 1));
  mesh.uvs = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  add_quad(mesh, 0, 1, 2, 3);
  return mesh;
}

ImportedMesh cube_mesh() {
  ImportedMesh mesh;
  mesh.name = "cube";
  // Of each face: the normal, and the directions in which u and v grow.
  constexpr int faces[6][3][3] = {
      {{0, -1, 0}, {0, 0, 1}, {1, 0, 0}}, {{0, 1, 0}, {-1, 0, 0}, {0, 0, -1}},
      {{1, 0, 0}, {0, 1, 0}, {0, 0, -1}}, {{0, 0, 1}, {0, 1, 0}, {1, 0, 0}},
      {{-1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 0, -1}, {0, -1, 0}, {1, 0, 0}}};
  for (const auto& f : faces) {
    const V3f n(f[0][0], f[0][1], f[0][2]), u(f[1][0], f[1][1], f[1][2]),
        v(f[2][0], f[2][1], f[2][2]);
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (const V2f& at : {V2f(0, 0), V2f(1, 0), V2f(1, 1), V2f(0, 1)}) {
      mesh.positions.push_back(n + u * (2 * at.x - 1) + v * (2 * at.y - 1));
      mesh.normals.push_back(n);
      mesh.uvs.push_back(at);
    }
    if (u.cross(v).dot(n) > 0) {
      add_quad(mesh, first, first + 1, first + 2, first + 3);
    } else {
      add_quad(mesh, first, first + 3, first + 2, first + 1);
    }
  }
  return mesh;
}

}  // namespace lacuna
