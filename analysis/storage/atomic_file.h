#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace lacuna {

/// Replaces `file` as a whole: a temporary beside it, write, fsync, rename, fsync of the folder. A
/// reader sees the old content or the new, also after a power cut. Throws std::system_error that
/// names the file (disk full, no permission); the old content is then there again, even if only the
/// last step failed, and no temporary is left. Where it cannot be put back, the new content stands
/// and nothing is thrown: what is told and what is seen agree. `sync = false` leaves out both
/// fsyncs, for what may be lost (progress).
void write_file_atomically(const std::filesystem::path& file, std::string_view content,
                           bool sync = true);

/// The whole of a regular file (through links no further than the name itself), at most
/// `max_bytes`. Throws std::system_error, or std::length_error if it is larger.
std::string read_file(const std::filesystem::path& file, std::size_t max_bytes);

}  // namespace lacuna
