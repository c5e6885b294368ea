#pragma once

#include <array>
#include <cstdint>
#include <cstring>
#include <limits>

#include "renderer/gltf/gltf_model.h"

namespace lacuna::gltf {

/// The component types that an accessor may have, by its use.
enum class Components {
  floats,      ///< floats only
  quantized,   ///< floats or integers of 8 or 16 bits, as KHR_mesh_quantization allows
  normalized,  ///< floats or such integers that are normalised
  joints,      ///< unsigned integers of 8 or 16 bits, not normalised
  indices,     ///< unsigned integers of 8, 16 or 32 bits
};

/// The elements of an accessor that `sparse` replaces.
class SparseElements {
 public:
  static constexpr std::size_t none = std::numeric_limits<std::size_t>::max();

  SparseElements() = default;
  /// `place` names the accessor in errors. Throws SceneError unless the indices are below its count
  /// and each is above the one before.
  SparseElements(const file::Model& model, const file::Accessor& accessor,
                 const std::string& place);

  bool empty() const { return count_ == 0; }
  /// Index of element `i` among the replaced elements; `none` if it is not replaced.
  std::size_t find(std::size_t i) const;
  const unsigned char* values() const { return values_; }

 private:
  std::uint32_t index(std::size_t k) const;

  const unsigned char* indices_ = nullptr;
  const unsigned char* values_ = nullptr;
  std::size_t count_ = 0;
  int component_ = 0;
};

/// Reads the elements of one glTF accessor. check_structure() has validated that they lie inside
/// their buffers. Without a bufferView, those that are not sparse are 0.
class AccessorView {
 public:
  /// `use`: names the accessor in errors. Throws SceneError if the
  /// accessor has another type or other components.
  AccessorView(const file::Model& model, int accessor, ElementType type, Components components,
               const std::string& use);

  std::size_t size() const { return count_; }
  /// Element `i` as floats; normalised integers become [0, 1] or [-1, 1].
  template <std::size_t N>
  std::array<float, N> floats(std::size_t i) const {
    std::array<float, N> out{};
    const unsigned char* from = element(i);
    if (from == nullptr) return out;
    if (component_ == component_float) {
      std::memcpy(out.data(), from, sizeof out);
      return out;
    }
    for (std::size_t k = 0; k < N; ++k) out[k] = component(from, k);
    return out;
  }
  /// Component `k` of element `i` of an accessor of indices or joints.
  std::uint32_t integer(std::size_t i, std::size_t k) const;
  std::uint32_t index(std::size_t i) const { return integer(i, 0); }

 private:
  /// Null if the element is 0: not sparse, in an accessor without a bufferView.
  const unsigned char* element(std::size_t i) const {
    if (!sparse_.empty()) {
      const std::size_t at = sparse_.find(i);
      if (at != SparseElements::none) return sparse_.values() + at * element_bytes_;
    }
    return data_ == nullptr ? nullptr : data_ + i * stride_;
  }
  float component(const unsigned char* from, std::size_t k) const;

  const unsigned char* data_ = nullptr;
  std::size_t stride_ = 0;
  std::size_t count_ = 0;
  std::size_t element_bytes_ = 0;
  int component_ = 0;
  bool normalized_ = false;
  SparseElements sparse_;
};

}  // namespace lacuna::gltf
