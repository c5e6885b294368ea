#pragma once

#include <string>
#include <vector>

#include "base/storage/bytes.h"
#include "renderer/images/exr_write.h"

namespace lacuna {

/// The position of a layer in a file of half floats.
struct HalfLayer {
  std::string name;
  std::vector<std::string> channels;
  std::size_t offset = 0, bytes = 0;
  double scale = 1;  ///< a power of two; value = half float * scale
};

/// Packs `layers`, whose values are finite, for a viewer that reads no EXR: little-endian IEEE
/// halves, interleaved, top row first, one layer after the other. Each layer is scaled so that its
/// largest magnitude lies in [2^14, 2^15): nothing overflows, and values up to 2^28 times smaller
/// keep all 11 bits. `out` gets the bytes; the result says what lies where in them.
std::vector<HalfLayer> pack_half(const std::vector<ExrLayer>& layers, ByteWriter& out);

}  // namespace lacuna
