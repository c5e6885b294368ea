#include "renderer/gltf/gltf_duplicates.h"

#include <fmt/format.h>
#include <xxhash.h>

#include <algorithm>
#include <unordered_map>

namespace lacuna::gltf {
namespace {

struct Emitter {
  const Mesh* mesh;
  std::array<std::uint32_t, 3> corners;  ///< from the one with the smallest position on
};

Emitter emitter(const Mesh& mesh, const std::array<std::uint32_t, 3>& t) {
  Emitter e{&mesh, t};
  const auto before = [&mesh](std::uint32_t a, std::uint32_t b) {
    const V3f &p = mesh.positions[a], &q = mesh.positions[b];
    return std::tuple(p.x, p.y, p.z) < std::tuple(q.x, q.y, q.z);
  };
  const auto first = std::min_element(e.corners.begin(), e.corners.end(), before);
  std::rotate(e.corners.begin(), first, e.corners.end());
  return e;
}

std::uint64_t hash(const Emitter& e) {
  std::array<float, 9> values;
  for (std::size_t i = 0; i < values.size(); ++i) {
    values[i] = e.mesh->positions[e.corners[i / 3]][static_cast<int>(i % 3)] + 0.0F;  // -0 is 0
  }
  return XXH3_64bits(values.data(), sizeof values);
}

bool equal(const Material& a, const Material& b) {
  Material other = b;
  other.name = a.name;
  return a == other;
}

bool equal(const Emitter& a, const Emitter& b, const std::vector<Material>& materials) {
  const Mesh &m = *a.mesh, &n = *b.mesh;
  const auto same = [&](const auto& of_m, const auto& of_n) {
    if (of_m.empty() || of_n.empty()) return of_m.empty() && of_n.empty();
    for (std::size_t k = 0; k < 3; ++k) {
      if (of_m[a.corners[k]] != of_n[b.corners[k]]) return false;
    }
    return true;
  };
  return same(m.positions, n.positions) && same(m.normals, n.normals) && same(m.uvs[0], n.uvs[0]) &&
         same(m.uvs[1], n.uvs[1]) && same(m.colors, n.colors) &&
         (m.material == n.material || equal(materials[m.material], materials[n.material]));
}

}  // namespace

void merge_equal_emitters(SceneData& scene, Warnings& warnings) {
  std::unordered_multimap<std::uint64_t, Emitter> kept;
  std::size_t merged = 0;
  std::string which;
  for (Mesh& mesh : scene.meshes) {
    if (!scene.materials[mesh.material].emits()) continue;
    std::erase_if(mesh.triangles, [&](const std::array<std::uint32_t, 3>& t) {
      const Emitter e = emitter(mesh, t);
      const std::uint64_t key = hash(e);
      const auto [begin, end] = kept.equal_range(key);
      const auto found = std::find_if(
          begin, end, [&](const auto& k) { return equal(k.second, e, scene.materials); });
      if (found == end) {
        kept.emplace(key, e);
        return false;
      }
      if (merged++ == 0)
        which = fmt::format("\"{}\", on \"{}\"", mesh.name, found->second.mesh->name);
      return true;
    });
  }
  if (merged == 0) return;
  std::erase_if(scene.meshes, [](const Mesh& mesh) { return mesh.triangles.empty(); });
  warnings.once(fmt::format(
      "{} emitting triangles lie exactly on others with the same material and were merged with "
      "them (the first is of mesh {}): a lamp that is there twice shines once",
      merged, which));
}

}  // namespace lacuna::gltf
