#include "jobs/import/glb_document.h"

#include <algorithm>
#include <stdexcept>

namespace lacuna {
namespace {

constexpr int float_component = 5126, uint_component = 5125;

template <class V>
OrderedJson of_floats(const std::vector<V>& values, const char* type) {
  return {{"componentType", float_component}, {"count", values.size()}, {"type", type}};
}

}  // namespace

GlbDocument::GlbDocument(std::string_view generator) {
  json_["asset"] = {{"version", "2.0"}, {"generator", generator}};
  json_["scene"] = 0;
  json_["scenes"] = {{{"nodes", OrderedJson::array()}}};
}

std::size_t GlbDocument::add(const char* list, OrderedJson item) {
  json_[list].push_back(std::move(item));
  return json_[list].size() - 1;
}

std::size_t GlbDocument::add_accessor(const void* data, std::size_t bytes, OrderedJson what) {
  what["bufferView"] =
      add("bufferViews", {{"buffer", 0}, {"byteOffset", buffer_.size()}, {"byteLength", bytes}});
  buffer_.append(static_cast<const char*>(data), bytes);
  return add("accessors", std::move(what));
}

std::size_t GlbDocument::add_positions(const std::vector<V3f>& positions) {
  V3f low = positions.at(0), high = low;
  for (const V3f& p : positions) {
    for (int a = 0; a < 3; ++a) {
      low[a] = std::min(low[a], p[a]);
      high[a] = std::max(high[a], p[a]);
    }
  }
  OrderedJson what = of_floats(positions, "VEC3");
  what["min"] = {low.x, low.y, low.z};
  what["max"] = {high.x, high.y, high.z};
  return add_accessor(positions.data(), positions.size() * sizeof(V3f), std::move(what));
}

std::size_t GlbDocument::add_vectors(const std::vector<V3f>& vectors) {
  return add_accessor(vectors.data(), vectors.size() * sizeof(V3f), of_floats(vectors, "VEC3"));
}

std::size_t GlbDocument::add_vectors(const std::vector<V2f>& vectors) {
  return add_accessor(vectors.data(), vectors.size() * sizeof(V2f), of_floats(vectors, "VEC2"));
}

std::size_t GlbDocument::add_colors(const std::vector<Rgb>& colors) {
  return add_accessor(colors.data(), colors.size() * sizeof(Rgb), of_floats(colors, "VEC3"));
}

std::size_t GlbDocument::add_triangles(const std::vector<std::array<std::uint32_t, 3>>& triangles) {
  return add_accessor(
      triangles.data(), triangles.size() * sizeof(triangles[0]),
      {{"componentType", uint_component}, {"count", triangles.size() * 3}, {"type", "SCALAR"}});
}

std::size_t GlbDocument::add_node(OrderedJson node) {
  const std::size_t index = add("nodes", std::move(node));
  json_["scenes"][0]["nodes"].push_back(index);
  return index;
}

std::size_t GlbDocument::add_node(OrderedJson node, std::size_t parent) {
  const std::size_t index = add("nodes", std::move(node));
  json_["nodes"][parent]["children"].push_back(index);
  return index;
}

std::string GlbDocument::glb() {
  if (!buffer_.empty()) json_["buffers"] = {{{"byteLength", buffer_.size()}}};
  std::string text = json_text(json_);
  text.resize((text.size() + 3) / 4 * 4, ' ');
  constexpr std::size_t header = 12, chunk_header = 8;
  const std::size_t size =
      header + chunk_header + text.size() + (buffer_.empty() ? 0 : chunk_header + buffer_.size());
  if (size > 0xFFFFFFFFU) throw std::length_error("the scene is larger than a GLB's 4 GiB");
  std::string file;
  const auto put = [&file](std::size_t value) {
    const auto v = static_cast<std::uint32_t>(value);
    file.append(reinterpret_cast<const char*>(&v), sizeof v);
  };
  constexpr std::uint32_t magic = 0x46546c67, json_chunk = 0x4e4f534a, binary_chunk = 0x004e4942;
  put(magic), put(2), put(size);
  put(text.size()), put(json_chunk);
  file += text;
  if (buffer_.empty()) return file;
  put(buffer_.size()), put(binary_chunk);
  return file + buffer_;
}

OrderedJson gltf_matrix(const M44d& to_parent) {
  OrderedJson matrix = OrderedJson::array();
  for (int row = 0; row < 4; ++row) {
    for (int column = 0; column < 4; ++column) matrix.push_back(to_parent[row][column]);
  }
  return matrix;
}

OrderedJson gltf_vector(const V3d& v) { return {v.x, v.y, v.z}; }

}  // namespace lacuna
