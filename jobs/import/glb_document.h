#pragma once

#include <array>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "base/json/json_text.h"
#include "renderer/core/vec.h"

namespace lacuna {

/// Builds a GLB: a glTF document with one scene and one buffer.
class GlbDocument {
 public:
  /// `generator`: asset.generator.
  explicit GlbDocument(std::string_view generator);

  /// Appends to a list at the top of the document ("meshes") and returns the item's index.
  std::size_t add(const char* list, OrderedJson item);
  /// The document, for what is no list.
  OrderedJson& json() { return json_; }
  /// Accessors of vertex attributes; POSITION needs its bounds.
  std::size_t add_positions(const std::vector<V3f>& positions);
  std::size_t add_vectors(const std::vector<V3f>& vectors);
  std::size_t add_vectors(const std::vector<V2f>& vectors);
  std::size_t add_colors(const std::vector<Rgb>& colors);
  std::size_t add_triangles(const std::vector<std::array<std::uint32_t, 3>>& triangles);
  /// Adds a node to the scene, or below `parent`.
  std::size_t add_node(OrderedJson node);
  std::size_t add_node(OrderedJson node, std::size_t parent);

  /// The file. Throws std::length_error if it would exceed 4 GiB.
  std::string glb();

 private:
  std::size_t add_accessor(const void* data, std::size_t bytes, OrderedJson what);

  OrderedJson json_;
  std::string buffer_;
};

/// A `matrix` of glTF: row vectors are its columns.
OrderedJson gltf_matrix(const M44d& to_parent);
OrderedJson gltf_vector(const V3d& v);
inline OrderedJson gltf_color(const Rgb& c) { return {c.x, c.y, c.z}; }

}  // namespace lacuna
