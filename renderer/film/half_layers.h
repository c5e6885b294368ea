#pragma once

#include <string>
#include <vector>

#include "renderer/images/exr_write.h"

namespace lacuna {

/// Where a layer lies in a file of half floats.
struct HalfLayer {
  std::string name;
  std::vector<std::string> channels;
  std::size_t offset = 0, bytes = 0;
  double scale = 1;  ///< a power of two; a value is its half times this
};

/// Layers for a viewer that reads no EXR: little-endian IEEE halves, interleaved, top row first,
/// one layer after the other. Each is scaled so that its largest magnitude lies in [2^14, 2^15):
/// nothing overflows, and what is up to 2^28 times darker keeps all 11 bits.
struct HalfLayers {
  std::vector<HalfLayer> index;
  std::string bytes;
};

/// Packs `layers`, whose values are finite.
HalfLayers pack_half(const std::vector<ExrLayer>& layers);

}  // namespace lacuna
