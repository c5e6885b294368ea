#pragma once

#include <filesystem>

namespace lacuna {

/// Checks the header of an OpenEXR file for what the libraries take on trust: OpenEXR makes room
/// for an attribute of any size before it looks whether the file has one, and a channel of an
/// unknown type is taken on trust, too. Throws SceneError: an attribute or a header that goes
/// beyond the end of the file, an attribute without the size of its type, an unknown channel type.
void check_exr_header(const std::filesystem::path& file);

}  // namespace lacuna
