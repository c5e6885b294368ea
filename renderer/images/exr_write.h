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

/// The content of an EXR file.
struct ExrPicture {
  int width = 0, height = 0;
  std::vector<ExrLayer> layers;
  PixelType type = PixelType::single_float;       ///< of all values
  std::map<std::string, std::string> attributes;  ///< written under "lacuna:NAME"
};

/// Writes a scan-line EXR (ZIP) atomically (temporary file, fsync, rename).
/// The file holds no date. Throws std::system_error or std::runtime_error that names the file; also
/// if the type is half and a value would overflow.
void write_exr(const std::filesystem::path& file, const ExrPicture& picture);

}  // namespace lacuna
