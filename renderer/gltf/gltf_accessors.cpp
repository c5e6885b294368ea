#include "renderer/gltf/gltf_accessors.h"

#include <algorithm>

#include "renderer/geometry/scene_data.h"

namespace lacuna::gltf {
namespace {

/// The `k`-th T from `from` on; buffers need not be aligned.
template <class T>
T load(const unsigned char* from, std::size_t k) {
  T value;
  std::memcpy(&value, from + k * sizeof(T), sizeof(T));
  return value;
}

std::uint32_t load_index(const unsigned char* from, std::size_t k, int component) {
  switch (component) {
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return load<std::uint8_t>(from, k);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return load<std::uint16_t>(from, k);
    default:
      return load<std::uint32_t>(from, k);
  }
}

bool is_unsigned(int component) {
  return component == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE ||
         component == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT;
}

bool allows(Components use, int component, bool normalized) {
  const bool small_integer = is_unsigned(component) || component == TINYGLTF_COMPONENT_TYPE_BYTE ||
                             component == TINYGLTF_COMPONENT_TYPE_SHORT;
  const bool is_float = component == TINYGLTF_COMPONENT_TYPE_FLOAT;
  switch (use) {
    case Components::floats:
      return is_float;
    case Components::quantized:
      return is_float || small_integer;
    case Components::normalized:
      return is_float || (small_integer && normalized);
    case Components::joints:
      return is_unsigned(component) && !normalized;
    case Components::indices:
      return is_unsigned(component) || component == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
  }
  return false;
}

const unsigned char* bytes_of(const tinygltf::Model& model, int buffer_view, std::size_t offset) {
  const auto& view = model.bufferViews[static_cast<std::size_t>(buffer_view)];
  return model.buffers[static_cast<std::size_t>(view.buffer)].data.data() + view.byteOffset +
         offset;
}

}  // namespace

SparseElements::SparseElements(const tinygltf::Model& model, const tinygltf::Accessor& accessor,
                               const std::string& place) {
  if (!accessor.sparse.isSparse) return;
  const auto& indices = accessor.sparse.indices;
  const auto& values = accessor.sparse.values;
  indices_ = bytes_of(model, indices.bufferView, static_cast<std::size_t>(indices.byteOffset));
  values_ = bytes_of(model, values.bufferView, static_cast<std::size_t>(values.byteOffset));
  count_ = static_cast<std::size_t>(accessor.sparse.count);
  component_ = indices.componentType;
  for (std::size_t k = 0; k < count_; ++k) {
    const auto fail = [&](const std::string& allowed) {
      throw SceneError(place + ": sparse.indices[" + std::to_string(k) + "] is " +
                       std::to_string(index(k)) + "; allowed: " + allowed);
    };
    if (index(k) >= accessor.count) fail("below its count, " + std::to_string(accessor.count));
    if (k > 0 && index(k) <= index(k - 1)) {
      fail("above the one before, " + std::to_string(index(k - 1)));
    }
  }
}

std::uint32_t SparseElements::index(std::size_t k) const {
  return load_index(indices_, k, component_);
}

std::size_t SparseElements::find(std::size_t i) const {
  std::size_t low = 0;
  std::size_t high = count_;
  while (low < high) {
    const std::size_t middle = low + (high - low) / 2;
    if (index(middle) < i) {
      low = middle + 1;
    } else {
      high = middle;
    }
  }
  return low < count_ && index(low) == i ? low : none;
}

AccessorView::AccessorView(const tinygltf::Model& model, int accessor, int type,
                           Components components, const std::string& use) {
  const tinygltf::Accessor& a = model.accessors[static_cast<std::size_t>(accessor)];
  const std::string place = "accessors[" + std::to_string(accessor) + "], used as " + use;
  if (a.type != type || !allows(components, a.componentType, a.normalized)) {
    throw SceneError(place + ": its type, componentType " + std::to_string(a.componentType) +
                     " or normalized is not one that glTF allows for this use");
  }
  if (a.bufferView >= 0) {
    const auto& view = model.bufferViews[static_cast<std::size_t>(a.bufferView)];
    data_ = bytes_of(model, a.bufferView, a.byteOffset);
    stride_ = static_cast<std::size_t>(a.ByteStride(view));
  }
  count_ = a.count;
  component_ = a.componentType;
  normalized_ = a.normalized;
  element_bytes_ = static_cast<std::size_t>(
      tinygltf::GetComponentSizeInBytes(static_cast<std::uint32_t>(a.componentType)) *
      tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(a.type)));
  sparse_ = SparseElements(model, a, place);
}

std::uint32_t AccessorView::index(std::size_t i) const {
  const unsigned char* from = element(i);
  return from == nullptr ? 0 : load_index(from, 0, component_);
}

float AccessorView::component(const unsigned char* from, std::size_t k) const {
  // glTF 2.0, section 3.6.2.2: the lowest signed integer stands for -1 like the next one.
  const auto scaled = [this](float value, float most) {
    return normalized_ ? std::max(value / most, -1.0F) : value;
  };
  switch (component_) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
      return scaled(load<std::int8_t>(from, k), 127.0F);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return scaled(load<std::uint8_t>(from, k), 255.0F);
    case TINYGLTF_COMPONENT_TYPE_SHORT:
      return scaled(load<std::int16_t>(from, k), 32767.0F);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return scaled(load<std::uint16_t>(from, k), 65535.0F);
    default:
      return load<float>(from, k);
  }
}

}  // namespace lacuna::gltf
