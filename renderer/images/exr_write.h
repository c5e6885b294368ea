#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "renderer/settings/output_settings.h"

namespace lacuna {

/// One layer of an EXR file: `width * height * channels.size()` values, interleaved, top row first.
struct ExrLayer {
  std::string name;                   ///< "" for the picture itself, whose channels are R, G, B
  std::vector<std::string> channels;  ///< e.g. {"R", "G", "B"}, {"Z"}
  std::vector<double> values;
  /// Instead of `values`, without a copy: these sums, which must outlive the layer, over `divisor`.
  std::span<const double> sums = {};
  double divisor = 1;

  std::size_t size() const { return sums.empty() ? values.size() : sums.size(); }
  double value(std::size_t i) const { return sums.empty() ? values[i] : sums[i] / divisor; }
};

/// The content of an EXR file.
struct ExrPicture {
  int width = 0, height = 0;
  std::vector<ExrLayer> layers;
  PixelType type = PixelType::single_float;       ///< of all values
  std::map<std::string, std::string> attributes;  ///< written under "lacuna:NAME"
};

/// Writes a scan-line EXR (ZIP) atomically (temporary file, fsync, rename), without a date. Throws
/// std::system_error or std::runtime_error that names the file; also if the type is half and a
/// value would overflow. `between` is called between blocks of at most 16 MiB (at least 16 rows);
/// an exception from it ends the writing.
void write_exr(const std::filesystem::path& file, const ExrPicture& picture,
               const std::function<void()>& between = {});

}  // namespace lacuna
