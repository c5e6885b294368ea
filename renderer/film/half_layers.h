#pragma once

#include <string>
#include <vector>

#include "base/storage/bytes.h"
#include "renderer/images/exr_write.h"

namespace lacuna {

/// The position of a layer in a file of half-precision floats.
struct HalfLayer {
  std::string name;
  std::vector<std::string> channels;
  std::size_t offset = 0, bytes = 0;
  double scale = 1;  ///< a power of two; value = half float * scale
};

/// Packs `layers`, whose values are finite, for a viewer that does not read EXR: little-endian IEEE
/// half floats, interleaved, top row first, layer by layer. Each layer is scaled so that its
/// largest magnitude lies in [2^14, 2^15): no value overflows, and values up to 2^28 times smaller
/// keep all 11 bits. Appends to `out` and returns the positions of the layers in it.
std::vector<HalfLayer> pack_half(const std::vector<ExrLayer>& layers, ByteWriter& out);

}  // namespace lacuna
