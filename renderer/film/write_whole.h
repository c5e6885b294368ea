#pragma once

#include <OpenImageIO/imageio.h>

#include <filesystem>

namespace lacuna {

/// Encodes an image with OpenImageIO's plug-in `format` in memory and puts the file in place as a
/// whole. Included only where images are written. Throws std::runtime_error or std::system_error
/// naming the file.
void write_whole(const std::filesystem::path& file, const char* format, const OIIO::ImageSpec& spec,
                 const OIIO::TypeDesc& type, const void* pixels);

}  // namespace lacuna
