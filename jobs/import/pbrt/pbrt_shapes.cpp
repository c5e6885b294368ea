#include "jobs/import/pbrt/pbrt_shapes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "jobs/import/input_bytes.h"
#include "jobs/import/mesh_normals.h"
#include "jobs/import/pbrt/pbrt_surfaces.h"
#include "jobs/import/ply_mesh.h"
#include "jobs/import/shape_meshes.h"
#include "renderer/core/scene_error.h"

namespace lacuna::pbrt {
namespace {

V3f position(const ImportedMesh& mesh, const std::array<std::uint32_t, 3>& t, std::size_t i) {
  return mesh.positions[t[i]];
}

ImportedMesh cone(double phi_max) {
  const double n = std::numbers::sqrt2 / 2;
  return revolution_mesh("cone", {{1, 0, n, n, 0}, {0, 1, n, n, 1}}, phi_max);
}

/// z = r^2 from z_min to 1.
ImportedMesh paraboloid(double z_min, double phi_max) {
  std::vector<ProfilePoint> profile;
  constexpr int steps = 64;
  for (int i = 0; i <= steps; ++i) {
    const double r = std::sqrt(z_min) + (1 - std::sqrt(z_min)) * i / steps, z = r * r;
    const double length = std::hypot(2 * r, 1.0);
    profile.push_back({r, z, 2 * r / length, -1 / length, (z - z_min) / (1 - z_min)});
  }
  return revolution_mesh("paraboloid", profile, phi_max);
}

}  // namespace

bool has_mirrored_uvs(const ImportedMesh& mesh, bool flipped) {
  if (mesh.uvs.empty()) return false;
  double right = 0, left = 0;
  for (const auto& t : mesh.triangles) {
    const V2f a = mesh.uvs[t[1]] - mesh.uvs[t[0]], b = mesh.uvs[t[2]] - mesh.uvs[t[0]];
    const double area = double(a.x) * double(b.y) - double(a.y) * double(b.x);
    (area > 0 ? right : left) += std::abs(area);
  }
  return flipped ? right > left : left > right;
}

Areas areas_of(const ImportedMesh& mesh, const M44d& to_world) {
  Areas out;
  for (const auto& t : mesh.triangles) {
    std::array<V3d, 3> p;
    for (std::size_t i = 0; i < 3; ++i) p[i] = V3d(position(mesh, t, i)) * to_world;
    const double area = (p[1] - p[0]).cross(p[2] - p[0]).length() / 2;
    out.least = out.total == 0 ? area : std::min(out.least, area);
    out.most = std::max(out.most, area);
    out.total += area;
  }
  return out;
}

void read_vertices(const Parameters& p, ImportedMesh& mesh) {
  const auto vectors = [](std::span<const double> values) {
    std::vector<V3f> out;
    for (std::size_t i = 0; i + 2 < values.size(); i += 3) {
      out.emplace_back(V3d(values[i], values[i + 1], values[i + 2]));
    }
    return out;
  };
  mesh.positions = vectors(p.groups("P", 3, {"point3"}));
  mesh.normals = vectors(p.groups("N", 3, {"normal"}));
  auto uv = p.groups("uv", 2, {"point2", "float"});
  if (uv.empty()) uv = p.groups("st", 2, {"point2", "float"});
  for (std::size_t i = 0; i + 1 < uv.size(); i += 2) mesh.uvs.emplace_back(V2d(uv[i], uv[i + 1]));
  const auto require = [&](std::size_t count, const char* name) {
    if (count == 0 || count == mesh.positions.size()) return;
    fail(p.place(), fmt::format("{}: {} of \"{}\" for {} points", p.owner(), count, name,
                                mesh.positions.size()));
  };
  require(mesh.normals.size(), "N");
  require(mesh.uvs.size(), "uv");
  if (!mesh.positions.empty()) return;
  fail(p.place(), fmt::format("{}: \"point3 P\" is missing", p.owner()));
}

template <class Make>
ShapeReader::Mesh ShapeReader::shared(const std::string& key, const Place& place, Make&& make) {
  Mesh& mesh = meshes_[key];
  if (mesh == nullptr) {
    mesh = std::make_shared<const ImportedMesh>(make());
    count(*mesh, place);
  }
  return mesh;
}

void ShapeReader::count(const ImportedMesh& mesh, const Place& place) {
  triangles_ += mesh.triangles.size();
  if (triangles_ > max_triangles) {
    fail(place, fmt::format("more than {} triangles in all meshes", max_triangles));
  }
}

ShapeReader::Mesh ShapeReader::triangle_mesh(const Parameters& p) {
  const auto mesh = std::make_shared<ImportedMesh>();
  mesh->name = "trianglemesh";
  read_vertices(p, *mesh);
  p.ignore({"faceIndices", "S"});  // of per-face textures; tangents of hair
  auto indices = p.indices("indices", 3, mesh->positions.size());
  if (indices.empty() && mesh->positions.size() == 3) indices = {0, 1, 2};
  if (indices.empty()) fail(p.place(), fmt::format("{}: \"indices\" is missing", p.owner()));
  for (std::size_t i = 0; i < indices.size(); i += 3) {
    mesh->triangles.push_back({indices[i], indices[i + 1], indices[i + 2]});
  }
  orient_by_normals(*mesh);
  return mesh;
}

ShapeReader::Mesh ShapeReader::ply(const Parameters& p) {
  const std::string name = p.text("filename", "");
  const auto file = context_.find_file(name, p.place(), p.owner());
  if (p.find("displacement", {"texture", "float"}) != nullptr) {
    context_.left_out(p.place(), p.owner(), "displacement of the surface");
  }
  p.ignore({"displacement.edgelength", "edgelength"});
  if (!file) return nullptr;
  return shared("plymesh " + name, p.place(), [&] {
    try {
      const std::string bytes = read_unzipped(*file, max_mesh_bytes);
      const std::span<const std::uint8_t> view(reinterpret_cast<const std::uint8_t*>(bytes.data()),
                                               bytes.size());
      ImportedMesh mesh = ply_mesh(view, file->string());
      mesh.colors.clear();  // pbrt does not read them
      orient_by_normals(mesh);
      return mesh;
    } catch (const SceneError& e) {
      fail(p.place(), e.what());
    }
  });
}

/// Quadrics, whose unit forms are shared.
std::optional<Geometry> ShapeReader::turned(const std::string& type, const Parameters& p) {
  const double turn = p.number_in("phimax", 360, 0, 360) * std::numbers::pi / 180;
  const double radius = p.number("radius", 1);
  if (!(radius > 0) || !(turn > 0)) {
    fail(p.place(),
         fmt::format("{}: radius {} and phimax {} rad; allowed: above 0", p.owner(), radius, turn));
  }
  Geometry out;
  const auto place = [&](double scale_z, double z) {
    out.to_object =
        M44d().setScale(V3d(radius, radius, scale_z)) * M44d().setTranslation(V3d(0, 0, z));
  };
  const double top = p.number("zmax", type == "cylinder" || type == "paraboloid" ? 1 : radius);
  const double bottom = p.number("zmin", type == "cylinder"     ? -1
                                         : type == "paraboloid" ? 0
                                                                : -radius);
  const double height = p.number("height", type == "cone" ? 1 : 0);
  if (type == "sphere") {
    const auto cut = [&](double z) { return std::clamp(z / radius, -1.0, 1.0); };
    const double from = cut(std::min(bottom, top)), to = cut(std::max(bottom, top));
    if (!(from < to)) return {};
    out.mesh = shared(fmt::format("sphere {} {} {}", from, to, turn), p.place(),
                      [&] { return sphere_mesh(from, to, turn); });
    place(radius, 0);
  } else if (type == "cylinder") {
    if (bottom == top) return {};
    out.mesh =
        shared(fmt::format("cylinder {}", turn), p.place(), [&] { return cylinder_mesh(turn); });
    place(std::abs(top - bottom), std::min(bottom, top));
  } else if (type == "disk") {
    const double inner = p.number("innerradius", 0) / radius;
    if (!(inner >= 0 && inner < 1)) {
      fail(p.place(),
           fmt::format("{}: innerradius {}; allowed: 0 to the radius", p.owner(), inner * radius));
    }
    out.mesh = shared(fmt::format("disk {} {}", inner, turn), p.place(),
                      [&] { return disk_mesh(inner, turn); });
    place(radius, height);
  } else if (type == "cone") {
    if (height == 0) return {};
    out.mesh = shared(fmt::format("cone {}", turn), p.place(), [&] { return cone(turn); });
    place(height, 0);
  } else {
    const double from = std::min(bottom, top), to = std::max(bottom, top);
    if (!(from >= 0 && from < to)) {
      fail(p.place(),
           fmt::format("{}: zmin {}, zmax {}; allowed: 0 <= zmin < zmax", p.owner(), from, to));
    }
    out.mesh = shared(fmt::format("paraboloid {} {}", from / to, turn), p.place(),
                      [&] { return paraboloid(from / to, turn); });
    place(to, 0);
  }
  return out;
}

std::optional<Geometry> ShapeReader::read(const std::string& type, const Parameters& p,
                                          bool reversed) {
  Geometry out;
  out.flipped = reversed;
  if (type == "trianglemesh") {
    out.mesh = triangle_mesh(p);
    count(*out.mesh, p.place());
  } else if (type == "plymesh") {
    out.mesh = ply(p);
  } else if (type == "bilinearmesh") {
    out.mesh = bilinear_mesh(context_, p);
    count(*out.mesh, p.place());
  } else if (type == "loopsubdiv") {
    out.mesh = loop_subdivision(context_, p);
    count(*out.mesh, p.place());
  } else if (type == "sphere" || type == "cylinder" || type == "disk" || type == "cone" ||
             type == "paraboloid") {
    const auto made = turned(type, p);
    if (!made) {
      context_.left_out(p.place(), p.owner(), "it has no area");
      return {};
    }
    out.mesh = made->mesh;
    out.to_object = made->to_object;
    context_.approximated(p.place(), p.owner(),
                          "triangles, whose error is below 3e-4 of the radius");
  } else if (type == "curve" || type == "hyperboloid" || type == "heightfield" ||
             type == "heightfield2" || type == "nurbs") {
    for (const Parameter& x : p.all()) x.used = true;
    context_.left_out(p.place(), p.owner(), "a shape of this type");
    return {};
  } else {
    fail(p.place(),
         fmt::format("shape \"{}\"; allowed: trianglemesh, plymesh, bilinearmesh, "
                     "loopsubdiv, sphere, disk, cylinder, cone, paraboloid, and left out: "
                     "curve, hyperboloid, heightfield, nurbs",
                     type));
  }
  if (out.mesh == nullptr) return {};
  if (out.mesh->triangles.empty()) {
    context_.left_out(p.place(), p.owner(), "it has no triangles");
    return {};
  }
  // pbrt-v3 turns no normals that the file states, and these decide what is in front.
  if (context_.is_v3() && !out.mesh->normals.empty() &&
      (type == "trianglemesh" || type == "plymesh")) {
    out.flipped = false;
  }
  return out;
}

}  // namespace lacuna::pbrt
