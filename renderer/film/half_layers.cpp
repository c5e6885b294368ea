#include "renderer/film/half_layers.h"

#include <Imath/half.h>

#include <algorithm>
#include <cmath>

namespace lacuna {

namespace {

double scale_of(const std::vector<double>& values) {
  double largest = 0;
  for (const double v : values) largest = std::max(largest, std::abs(v));
  return largest > 0 ? std::ldexp(1.0, std::ilogb(largest) - 14) : 1.0;
}

}  // namespace

HalfLayers pack_half(const std::vector<ExrLayer>& layers) {
  HalfLayers packed;
  for (const ExrLayer& layer : layers) {
    HalfLayer entry{layer.name, layer.channels, packed.bytes.size(), 2 * layer.values.size(),
                    scale_of(layer.values)};
    packed.bytes.resize(entry.offset + entry.bytes);
    char* out = packed.bytes.data() + entry.offset;
    for (const double v : layer.values) {
      const std::uint16_t bits = half(static_cast<float>(v / entry.scale)).bits();
      *out++ = static_cast<char>(bits & 0xff);
      *out++ = static_cast<char>(bits >> 8);
    }
    packed.index.push_back(std::move(entry));
  }
  return packed;
}

}  // namespace lacuna
