#include "renderer/gltf/gltf_accessors.h"

#include <algorithm>

#include "renderer/geometry/scene_data.h"

namespace lacuna::gltf {
namespace {

/// The `k`-th T from `from` on; buffers need not be aligned.
template <class T>
T component_at(const unsigned char* from, std::size_t k) {
  T value;
  std::memcpy(&value, from + k * sizeof(T), sizeof(T));
  return value;
}

std::uint32_t load_index(const unsigned char* from, std::size_t k, int component) {
  switch (component) {
    case component_u8:
      return component_at<std::uint8_t>(from, k);
    case component_u16:
      return component_at<std::uint16_t>(from, k);
    default:
      return component_at<std::uint32_t>(from, k);
  }
}

bool is_unsigned(int component) { return component == component_u8 || component == component_u16; }

bool allows(Components use, int component, bool normalized) {
  const bool small_integer =
      is_unsigned(component) || component == component_s8 || component == component_s16;
  const bool is_float = component == component_float;
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
      return is_unsigned(component) || component == component_u32;
  }
  return false;
}

}  // namespace

SparseElements::SparseElements(const file::Model& model, const file::Accessor& accessor,
                               const std::string& place) {
  const file::Sparse& sparse = accessor.sparse;
  if (sparse.count == 0) return;
  indices_ = model.bytes_of(sparse.indices_view, sparse.indices_offset);
  values_ = model.bytes_of(sparse.values_view, sparse.values_offset);
  count_ = sparse.count;
  component_ = sparse.indices_component;
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

AccessorView::AccessorView(const file::Model& model, int accessor, ElementType type,
                           Components components, const std::string& use) {
  const file::Accessor& a = model.accessors[static_cast<std::size_t>(accessor)];
  const std::string place = "accessors[" + std::to_string(accessor) + "], used as " + use;
  if (a.type != type || !allows(components, a.component, a.normalized)) {
    throw SceneError(place + ": its type, componentType " + std::to_string(a.component) +
                     " or normalized is not one that glTF allows for this use");
  }
  count_ = a.count;
  component_ = a.component;
  normalized_ = a.normalized;
  element_bytes_ = component_bytes(a.component) * component_count(a.type);
  if (a.view >= 0) {
    const auto view = static_cast<std::size_t>(a.view);
    data_ = model.bytes_of(view, a.offset);
    stride_ = model.views[view].stride > 0 ? model.views[view].stride : element_bytes_;
  }
  sparse_ = SparseElements(model, a, place);
}

std::uint32_t AccessorView::integer(std::size_t i, std::size_t k) const {
  const unsigned char* from = element(i);
  return from == nullptr ? 0 : load_index(from, k, component_);
}

float AccessorView::component(const unsigned char* from, std::size_t k) const {
  // glTF 2.0, section 3.6.2.2: the lowest signed integer stands for -1 like the next one.
  const auto scaled = [this](float value, float most) {
    return normalized_ ? std::max(value / most, -1.0F) : value;
  };
  switch (component_) {
    case component_s8:
      return scaled(component_at<std::int8_t>(from, k), 127.0F);
    case component_u8:
      return scaled(component_at<std::uint8_t>(from, k), 255.0F);
    case component_s16:
      return scaled(component_at<std::int16_t>(from, k), 32767.0F);
    case component_u16:
      return scaled(component_at<std::uint16_t>(from, k), 65535.0F);
    default:
      return component_at<float>(from, k);
  }
}

}  // namespace lacuna::gltf
