#include "jobs/import/mitsuba/shapes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/storage/input_file.h"
#include "jobs/import/mesh_normals.h"
#include "jobs/import/mitsuba/mesh_files.h"
#include "jobs/import/ply_mesh.h"
#include "jobs/import/shape_meshes.h"
#include "renderer/core/scene_error.h"

namespace lacuna::mitsuba {
namespace {

constexpr std::size_t max_group_depth = 16;
constexpr std::size_t max_shapes = std::size_t{1} << 20;

/// From a v that grows downwards in pictures, as Mitsuba's own coordinates do, to ours.
ImportedMesh v_turned(ImportedMesh mesh) {
  for (V2f& uv : mesh.uvs) uv.y = 1 - uv.y;
  return mesh;
}

/// Mitsuba's disk has the radius as u and the azimuth as v.
ImportedMesh polar_disk() {
  ImportedMesh mesh = disk_mesh();
  for (V2f& uv : mesh.uvs) uv = {1 - uv.y, 1 - uv.x};
  return mesh;
}

M44d scaled(const V3d& scale) {
  M44d m;
  m.setScale(scale);
  return m;
}

M44d translated(const V3d& by) {
  M44d m;
  m.setTranslation(by);
  return m;
}

bool is_mirroring(const M44d& m) { return m.determinant() < 0; }

std::string bytes_text(const InputBytes& bytes) { return {bytes.begin(), bytes.end()}; }

/// The bytes of a file that `at` calls `name`.
InputBytes bytes_of(const std::filesystem::path& file, const SceneElement& at,
                    const std::string& name) {
  InputFile about;
  try {
    return read_input(file, max_mesh_bytes, about);
  } catch (const std::logic_error& e) {
    throw SceneError(fmt::format("{}: {}: {}", at.place, name, e.what()));
  }
}

}  // namespace

void Shapes::add(const SceneElement& shape, const M44d& to_parent) {
  // Instances count, too: groups of groups multiply.
  if (++added_ > max_shapes) shape.fail("is one of more than 2^20 shapes");
  const Parameters p = context_.parameters(shape);
  if (shape.type() == "shapegroup") return;  // read where an instance names it
  if (shape.type() == "instance") return add_instance(p, to_parent);
  if (shape.type() == "merge") return add_group(shape, to_parent);
  Read read_mesh = read(p);
  const M44d to_world = p.transform("toworld") * to_parent;
  const bool flip = p.boolean("flipnormals", false);
  const auto emitters = p.objects("emitter");
  if (emitters.size() > 1) shape.fail("has more than one emitter");
  const SceneElement* light = emitters.empty() ? nullptr : emitters[0];
  if (light != nullptr && light->type() != "area") {
    context_.note(*light, "left out", "emitters of shapes that are read: area");
    context_.parameters(*light).ignore_all();
    light = nullptr;
  }
  const auto bsdfs = bsdfs_of(p, read_mesh);
  ImportedShape out;
  out.name = shape.attribute("id");
  out.place = shape.place;
  if (light != nullptr) {
    const Parameters emitter = context_.parameters(*light);
    out.radiance = textures_.value(emitter, "radiance", Rgb(1)).value;
    emitter.ignore({"samplingweight"});
    emitter.note_unread(context_.notes);
  }
  p.ignore({"id", "maxsmoothangle", "collapse", "loadmaterials", "shapeindex", "srgb"});
  for (const char* unread : {"subsurface", "sensor"}) {
    for (const SceneElement* e : p.objects(unread)) context_.note(*e, "left out", "is not read");
  }
  out.to_world = read_mesh.placing * to_world;
  for (std::size_t i = 0; i < read_mesh.parts.size(); ++i) {
    const MeshPointer& mesh = read_mesh.parts[i].mesh;
    const auto material = bsdfs[i] != nullptr ? materials_.of(*bsdfs[i])
                          : light == nullptr  ? materials_.fallback()
                                              : materials_.black();
    out.material = with_interior(p, material);
    out.mesh = mesh;
    if (!mesh->colors.empty() && !material->vertex_colors) {
      MeshPointer& plain = plain_[mesh.get()];
      if (!plain) {
        ImportedMesh without = *mesh;
        without.colors.clear();
        plain = std::make_shared<const ImportedMesh>(std::move(without));
      }
      out.mesh = plain;
    }
    // Without normals in the file Mitsuba's front is where the placed triangles are
    // counter-clockwise.
    const bool by_winding = wound_.contains(mesh.get());
    out.flipped = flip != (by_winding && is_mirroring(out.to_world));
    scene_.shapes.push_back(out);
  }
  p.note_unread(context_.notes);
}

void Shapes::add_group(const SceneElement& group, const M44d& to_parent) {
  if (std::find(open_.begin(), open_.end(), &group) != open_.end()) {
    group.fail("is within itself: a circle");
  }
  if (open_.size() >= max_group_depth) group.fail("is nested more than 16 groups deep");
  open_.push_back(&group);
  const Parameters p = context_.parameters(group);
  for (const SceneElement* shape : p.objects("shape")) add(*shape, to_parent);
  p.note_unread(context_.notes);
  open_.pop_back();
}

void Shapes::add_instance(const Parameters& p, const M44d& to_parent) {
  const auto groups = p.objects("shape");
  if (groups.size() != 1 || groups[0]->type() != "shapegroup") {
    p.element().fail("names no shapegroup; required: one");
  }
  const M44d to_world = p.transform("toworld") * to_parent;
  add_group(*groups[0], to_world);
  p.note_unread(context_.notes);
}

std::vector<const SceneElement*> Shapes::bsdfs_of(const Parameters& p, const Read& read) {
  std::vector<const SceneElement*> out(read.parts.size());
  std::vector<const SceneElement*> of_all;
  for (const auto& [name, bsdf] : p.named_objects("bsdf")) {
    bool named = false;
    for (std::size_t i = 0; i < out.size(); ++i) {
      if (name.empty() || read.parts[i].material != name) continue;
      out[i] = bsdf;
      named = true;
    }
    if (!named) of_all.push_back(bsdf);
  }
  if (of_all.size() > 1) {
    context_.note(p.element(), "approximated",
                  "its first BSDF is that of all its triangles that the others do not name");
  }
  const bool reads_libraries =
      context_.reads_mtl && of_all.empty() && p.boolean("loadmaterials", true);
  for (std::size_t i = 0; i < out.size(); ++i) {
    if (out[i] == nullptr && !of_all.empty()) out[i] = of_all[0];
    for (const std::string& name : read.libraries) {
      if (out[i] != nullptr || !reads_libraries) break;
      const auto& materials = library(p.element(), name);
      const auto found = materials.find(read.parts[i].material);
      if (found != materials.end()) out[i] = &found->second;
    }
  }
  return out;
}

const std::map<std::string, SceneElement>& Shapes::library(const SceneElement& at,
                                                           const std::string& name) {
  const auto [found, added] = libraries_.try_emplace(name);
  if (!added) return found->second;
  const auto file = context_.file(at, name);
  if (!file) {
    context_.note(at, "left out", fmt::format("{} is missing", name));
    return found->second;
  }
  const std::filesystem::path folder = std::filesystem::path(name).parent_path();
  const std::string text = bytes_text(bytes_of(*file, at, name));
  found->second = mtl_bsdfs(text, folder.empty() ? "" : folder.string() + "/",
                            fmt::format("{}: {}", at.place, name));
  return found->second;
}

/// A medium within a solid: its absorption.
std::shared_ptr<const ImportedMaterial> Shapes::with_interior(
    const Parameters& p, const std::shared_ptr<const ImportedMaterial>& material) {
  const SceneElement* medium = p.object("interior");
  if (p.object("exterior") != nullptr) {
    context_.note(p.element(), "left out", "the medium outside of it");
  }
  if (medium == nullptr) return material;
  auto& filled = filled_[{material.get(), medium}];
  if (filled) return filled;
  const Parameters m = context_.parameters(*medium);
  // Else a volume or the name of a material, whose coefficients are not known here.
  bool uniform = medium->type() == "homogeneous" && !m.has("material");
  for (const char* name : {"sigmat", "albedo", "sigmaa", "sigmas"}) {
    uniform = uniform && (!m.has(name) || m.color(name));
  }
  if (!uniform) {
    context_.note(*medium, "left out", "media that are read: homogeneous, of uniform coefficients");
    m.ignore_all();
    return filled = material;
  }
  const auto scale = static_cast<float>(m.number("scale", 1));
  const Rgb extinction = m.color("sigmat").value_or(Rgb(1)),
            albedo = m.color("albedo").value_or(Rgb(.75F));
  const Rgb absorption = m.color("sigmaa").value_or(extinction * (Rgb(1) - albedo)),
            scattering = m.color("sigmas").value_or(m.has("sigmaa") ? Rgb(0) : extinction * albedo);
  ImportedMaterial out = *material;
  out.absorption = absorption * scale;
  if (scattering != Rgb(0)) {
    context_.note(*medium, "approximated", "what it absorbs is read, not what it scatters");
  }
  if (material->type != ImportedMaterial::Type::dielectric) {
    context_.note(*medium, "left out", "a medium within what is no dielectric");
  }
  m.ignore_all();
  return filled = std::make_shared<const ImportedMaterial>(std::move(out));
}

void Shapes::note_rounded(const Parameters& p, const std::string& type) {
  if (!noted_.insert(type).second) return;
  scene_.notes.push_back({p.element().place, fmt::format("shapes ({})", type), "approximated",
                          fmt::format("{} segments a turn, with exact normals", turn_segments)});
}

Shapes::MeshPointer Shapes::unit_mesh(const std::string& type) {
  MeshPointer& mesh = units_[type];
  if (mesh) return mesh;
  ImportedMesh made = type == "sphere"      ? sphere_mesh()
                      : type == "cylinder"  ? v_turned(cylinder_mesh())
                      : type == "disk"      ? polar_disk()
                      : type == "rectangle" ? v_turned(rectangle_mesh())
                                            : v_turned(cube_mesh());
  return mesh = std::make_shared<const ImportedMesh>(std::move(made));
}

Shapes::Read Shapes::read(const Parameters& p) {
  const std::string& type = p.element().type();
  if (type == "sphere") return read_sphere(p);
  if (type == "cylinder") return read_cylinder(p);
  if (type == "disk") note_rounded(p, type);
  if (type == "disk" || type == "rectangle" || type == "cube") {
    return {{{"", unit_mesh(type)}}, {}};
  }
  if (type == "obj" || type == "ply" || type == "serialized") return load(p, type);
  context_.note(p.element(), "left out",
                "shapes that are read: obj, ply, serialized, rectangle, cube, sphere, disk, "
                "cylinder, shapegroup, instance, merge");
  p.ignore_all();
  return {};
}

Shapes::Read Shapes::read_sphere(const Parameters& p) {
  note_rounded(p, "sphere");
  const double radius = p.number("radius", 1);
  if (!(radius > 0)) p.element().fail("has a radius that is not above 0");
  return {{{"", unit_mesh("sphere")}},
          scaled(V3d(radius)) * translated(p.vector("center").value_or(V3d(0)))};
}

Shapes::Read Shapes::read_cylinder(const Parameters& p) {
  note_rounded(p, "cylinder");
  const V3d from = p.vector("p0").value_or(V3d(0, 0, 0)),
            to = p.vector("p1").value_or(V3d(0, 0, 1));
  const double radius = p.number("radius", 1), length = (to - from).length();
  if (!(radius > 0 && length > 0)) p.element().fail("has no radius or no length");
  const V3d z = (to - from) / length;
  // Any frame about its axis; for the default axis that of the coordinates.
  const V3d x = (std::abs(z.x) < .9 ? V3d(1, 0, 0) - z * z.x : V3d(0, 1, 0) - z * z.y).normalized(),
            y = z.cross(x);
  const M44d frame(x.x, x.y, x.z, 0, y.x, y.y, y.z, 0, z.x, z.y, z.z, 0, from.x, from.y, from.z, 1);
  return {{{"", unit_mesh("cylinder")}}, scaled({radius, radius, length}) * frame};
}

Shapes::Read Shapes::load(const Parameters& p, const std::string& kind) {
  const std::string name = p.text("filename", "");
  bool flat = p.boolean("facenormals", false);
  const bool turned = p.boolean("fliptexcoords", kind == "obj");
  const int index = p.integer("shapeindex", 0);
  if (index < 0) p.element().fail("has a shapeIndex below 0");
  const auto file = context_.file(p.element(), name);
  if (!file) {
    context_.note(p.element(), "left out", fmt::format("{} is missing", name));
    return {};
  }
  const auto [known, added] =
      files_.try_emplace(fmt::format("{} {} {} {}", file->string(), flat, turned, index));
  Read& out = known->second;
  if (!added) return out;
  const InputBytes bytes = bytes_of(*file, p.element(), name);
  const std::string label = fmt::format("{}: {}", p.element().place, name);
  ObjFile read;
  bool asks_flat = false;
  if (kind == "ply") {
    std::vector<std::string> skipped;
    read.parts.push_back({"", ply_mesh(bytes, label, &skipped)});
    for (const std::string& s : skipped) context_.note(p.element(), "left out", s + " of " + name);
  } else if (kind == "obj") {
    read = obj_file(bytes_text(bytes), label);
  } else {
    const auto of_file = static_cast<std::uint64_t>(index);
    read.parts.push_back({"", serialized_mesh(bytes, of_file, label, &asks_flat)});
  }
  flat = flat || asks_flat;
  for (auto& [material, mesh] : read.parts) {
    mesh.name = std::filesystem::path(name).stem().string();
    const bool by_winding = flat || mesh.normals.empty();
    if (flat) {
      mesh.normals.clear();
    } else if (mesh.normals.empty()) {
      add_smooth_normals(mesh);
    }
    orient_by_normals(mesh);
    // Mitsuba's own v points down: it turns that of an OBJ by default, and no other's.
    if (!turned) mesh = v_turned(std::move(mesh));
    out.parts.push_back({material, std::make_shared<const ImportedMesh>(std::move(mesh))});
    if (by_winding) wound_.insert(out.parts.back().mesh.get());
  }
  if (out.parts.empty()) {
    context_.note(p.element(), "left out", fmt::format("{} has no triangles", name));
  }
  for (const std::string& library : read.libraries) {
    out.libraries.push_back((std::filesystem::path(name).parent_path() / library).string());
  }
  return out;
}

}  // namespace lacuna::mitsuba
