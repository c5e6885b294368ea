#pragma once

#include <string>

#include "analysis/artefacts/entry_file.h"
#include "tests/temporary_folder.h"

namespace lacuna {

/// A key of a type of this test's own.
inline ArtefactKey key_of(const std::string& settings, std::uint32_t version = 1) {
  return ArtefactKey("numbers", version, settings).from("geometry", "00ff");
}

/// Writes `entry` under the name of `key`.
inline std::filesystem::path put_entry(const std::filesystem::path& folder, const ArtefactKey& key,
                                       const std::string& entry) {
  return put_file(folder / entry_name(key), entry);
}

}  // namespace lacuna
