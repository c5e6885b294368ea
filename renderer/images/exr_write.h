#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "renderer/settings/output_settings.h"

namespace lacuna {

/// One layer of an EXR file: `width * height * channels.size()` values, interleaved, top row first.
struct ExrLayer {
  std::string name;                   ///< "" for the picture itself, whose channels are R, G, B
  std::vector<std::string> channels;  ///< e.g. {"R", "G", "B"}, {"Z"}
  std::vector<double> values;
};

/// Writes a scan-line EXR (ZIP) atomically (temporary file, fsync, rename).
/// Attributes are strings, under "lacuna:NAME"; the file holds no date. Throws std::system_error or
/// std::runtime_error that names the file; also where `type` is half and a value would overflow.
void write_exr(const std::filesystem::path& file, int width, int height,
               const std::vector<ExrLayer>& layers, PixelType type,
               const std::map<std::string, std::string>& attributes);

}  // namespace lacuna
