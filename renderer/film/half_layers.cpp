#include "renderer/film/half_layers.h"

#include <Imath/half.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace lacuna {

namespace {

double scale_of(const ExrLayer& layer) {
  double largest = 0;
  for (std::size_t i = 0; i < layer.size(); ++i)
    largest = std::max(largest, std::abs(layer.value(i)));
  return largest > 0 ? std::ldexp(1.0, std::ilogb(largest) - 14) : 1.0;
}

}  // namespace

std::vector<HalfLayer> pack_half(const std::vector<ExrLayer>& layers, ByteWriter& out) {
  std::vector<HalfLayer> index;
  std::size_t offset = 0;
  std::array<std::uint16_t, 4096> block{};
  for (const ExrLayer& layer : layers) {
    index.push_back({layer.name, layer.channels, offset, sizeof(std::uint16_t) * layer.size(),
                     scale_of(layer)});
    for (std::size_t i = 0; i < layer.size(); i += block.size()) {
      const std::size_t n = std::min(block.size(), layer.size() - i);
      for (std::size_t k = 0; k < n; ++k) {
        block[k] = half(static_cast<float>(layer.value(i + k) / index.back().scale)).bits();
      }
      out.append(block.data(), sizeof(std::uint16_t) * n);
    }
    offset += index.back().bytes;
  }
  return index;
}

}  // namespace lacuna
