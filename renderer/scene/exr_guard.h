#pragma once

#include <filesystem>

namespace lacuna {

/// Checks the header of an OpenEXR file for what the library takes on trust: it makes room for an
/// attribute of any size before it looks whether the file has one. Throws SceneError: an attribute
/// or a header that goes beyond the end of the file.
void check_exr_header(const std::filesystem::path& file);

}  // namespace lacuna
