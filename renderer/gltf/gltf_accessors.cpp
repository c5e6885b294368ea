#include "renderer/gltf/gltf_accessors.h"

#include <algorithm>

#include "renderer/geometry/scene_data.h"

namespace lacuna::gltf {

AccessorView::AccessorView(const tinygltf::Model& model, int accessor, int type,
                           std::initializer_list<int> components, const std::string& use) {
  const tinygltf::Accessor& a = model.accessors[static_cast<std::size_t>(accessor)];
  const auto fail = [&](const std::string& what) {
    throw SceneError("accessors[" + std::to_string(accessor) + "], used as " + use + ": " + what);
  };
  if (a.sparse.isSparse) fail("sparse accessors are not supported");
  if (a.bufferView < 0) fail("it has no bufferView");
  const bool known =
      std::find(components.begin(), components.end(), a.componentType) != components.end();
  const bool integers = a.componentType != TINYGLTF_COMPONENT_TYPE_FLOAT;
  const bool scaled = type == TINYGLTF_TYPE_SCALAR || !integers || a.normalized;
  if (a.type != type || !known || !scaled) {
    fail("its type, componentType " + std::to_string(a.componentType) +
         " or normalized is not one that glTF allows for this use");
  }
  const auto& view = model.bufferViews[static_cast<std::size_t>(a.bufferView)];
  data_ = model.buffers[static_cast<std::size_t>(view.buffer)].data.data() + view.byteOffset +
          a.byteOffset;
  stride_ = static_cast<std::size_t>(a.ByteStride(view));
  count_ = a.count;
  component_ = a.componentType;
}

std::uint32_t AccessorView::index(std::size_t i) const {
  switch (component_) {
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return load<std::uint8_t>(i, 0);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return load<std::uint16_t>(i, 0);
    default:
      return load<std::uint32_t>(i, 0);
  }
}

float AccessorView::component(std::size_t i, std::size_t k) const {
  switch (component_) {
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return static_cast<float>(load<std::uint8_t>(i, k)) / 255.0F;
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return static_cast<float>(load<std::uint16_t>(i, k)) / 65535.0F;
    default:
      return load<float>(i, k);
  }
}

}  // namespace lacuna::gltf
