#pragma once

#include <string>

#include "jobs/figure/drawing.h"

namespace lacuna {

/// The picture as a JPEG of `quality` 1 to 100, without subsampling of colours. Throws
/// std::runtime_error.
std::string encode_jpeg(const CodeImage& image, int quality);

}  // namespace lacuna
