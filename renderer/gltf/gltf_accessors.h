#pragma once

#include <array>
#include <cstdint>
#include <cstring>

#include "renderer/gltf/gltf_model.h"

namespace lacuna::gltf {

/// Reads the elements of one glTF accessor. check_structure() has validated that they lie inside
/// their buffer.
class AccessorView {
 public:
  /// `type`: TINYGLTF_TYPE_*; `components`: the allowed component types; `use`: names the accessor
  /// in errors. Throws SceneError if the accessor has another type, has no bufferView or is sparse.
  AccessorView(const tinygltf::Model& model, int accessor, int type,
               std::initializer_list<int> components, const std::string& use);

  std::size_t size() const { return count_; }
  /// Element `i` as floats; normalised unsigned integers become [0, 1].
  template <std::size_t N>
  std::array<float, N> floats(std::size_t i) const {
    std::array<float, N> out;
    for (std::size_t k = 0; k < N; ++k) out[k] = component(i, k);
    return out;
  }
  /// Element `i` of a SCALAR accessor of unsigned integers.
  std::uint32_t index(std::size_t i) const;

 private:
  template <class T>
  T load(std::size_t i, std::size_t k) const {
    T value;  // buffers need not be aligned
    std::memcpy(&value, data_ + i * stride_ + k * sizeof(T), sizeof(T));
    return value;
  }
  float component(std::size_t i, std::size_t k) const;

  const unsigned char* data_ = nullptr;
  std::size_t stride_ = 0;
  std::size_t count_ = 0;
  int component_ = 0;
};

}  // namespace lacuna::gltf
