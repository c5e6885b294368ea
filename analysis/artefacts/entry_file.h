#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "analysis/artefacts/key.h"
#include "analysis/artefacts/packing.h"

namespace lacuna {

/// Why a file is not the expected entry.
enum class EntryFault {
  missing,        ///< there is no such file
  unreadable,     ///< the file system reports an error
  foreign,        ///< not a cache entry
  other_version,  ///< of another version of Lacuna
  other_key,      ///< an entry of another key
  cut_short,      ///< shorter than its header says
  damaged,        ///< wrong checksum or inconsistent sizes
  undecodable,    ///< intact, but its content is not such an artefact
};

struct EntryRefusal {
  EntryFault fault;
  std::string text;  ///< for people, without the file's name
};

/// The header of an entry.
struct EntryHeader {
  std::string type;                ///< of the artefact
  std::uint32_t version = 0;       ///< of that type
  std::string key;                 ///< ArtefactKey::text()
  std::string label;               ///< readable name of its inputs, such as the scene; may be empty
  std::uint64_t packed_bytes = 0;  ///< of its content, compressed
  std::uint64_t content_bytes = 0;  ///< of its content, uncompressed
};

/// The file name of a key's entry in the cache's folder.
std::string entry_name(const ArtefactKey& key);
/// Whether `name` has the form of entry_name().
bool is_entry_name(std::string_view name);

/// The bytes of an entry's file: magic number, format version, sizes, checksum (xxh3) of all that
/// follows, header, content (zstd).
std::string pack_entry(const ArtefactKey& key, const std::string& label,
                       const std::function<void(ArtefactWriter&)>& encode);
/// Sets the sizes and the checksum of `entry` for the content behind its header.
void seal_entry(std::string& entry, std::uint64_t content_bytes);

/// Reads the header without verifying the checksum. Returns the refusal, if any: faults in a file's
/// bytes are refusals, never exceptions, here and in the functions below.
std::optional<EntryRefusal> read_entry_header(const std::filesystem::path& file,
                                              EntryHeader& header);

/// Reads the header and verifies the checksum and the file's name.
std::optional<EntryRefusal> verify_entry(const std::filesystem::path& file, EntryHeader& header);

/// Verifies the checksum of `key`'s entry and passes its content to `decode`, which reads all of it
/// and throws std::runtime_error for invalid content. The decoded value is valid only if there is
/// no refusal. Throws std::bad_alloc, and other exceptions of `decode`.
std::optional<EntryRefusal> read_entry(const std::filesystem::path& file, const ArtefactKey& key,
                                       EntryHeader& header,
                                       const std::function<void(ArtefactReader&)>& decode);

}  // namespace lacuna
