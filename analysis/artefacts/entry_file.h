#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "analysis/artefacts/key.h"
#include "analysis/artefacts/packing.h"

namespace lacuna {

/// Why a file is not the entry that is looked for.
enum class EntryFault {
  missing,        ///< there is no such file
  unreadable,     ///< the file system gives an error
  foreign,        ///< no entry of a cache at all
  other_version,  ///< of another version of Lacuna
  other_key,      ///< an entry, but of something else
  cut_short,      ///< shorter than it says
  damaged,        ///< its checksum differs, its sizes do not agree
  undecodable,    ///< whole, but what it holds is no such artefact
};

struct EntryRefusal {
  EntryFault fault;
  std::string text;  ///< for people, without the file's name
};

/// What an entry says of itself.
struct EntryHeader {
  std::string type;                ///< of the artefact
  std::uint32_t version = 0;       ///< of that type
  std::string key;                 ///< ArtefactKey::text()
  std::string label;               ///< what people call its inputs, as a scene's name; may be empty
  std::uint64_t packed_bytes = 0;  ///< of its content as it lies in the file
  std::uint64_t content_bytes = 0;  ///< of its content
};

/// The name of a key's entry in the cache's folder.
std::string entry_name(const ArtefactKey& key);
/// Of the form that entry_name() makes.
bool is_entry_name(std::string_view name);

/// A whole entry as it lies on disk: magic number, format version, sizes, checksum (xxh3) of all
/// the rest, header, content (zstd).
std::string pack_entry(const ArtefactKey& key, const std::string& label,
                       const std::function<void(ArtefactWriter&)>& encode);
/// Sets the sizes and the checksum of `entry` for the content that stands behind its header.
void seal_entry(std::string& entry, std::uint64_t content_bytes);

/// The header alone; the checksum is not looked at. Nothing: all is well. What is wrong with a
/// file's bytes is a refusal, never an exception; so in the functions below.
std::optional<EntryRefusal> read_entry_header(const std::filesystem::path& file,
                                              EntryHeader& header);

/// The header, the checksum, and whether the file has the name of its key.
std::optional<EntryRefusal> verify_entry(const std::filesystem::path& file, EntryHeader& header);

/// Gives the content of `key`'s entry to `decode`, which reads all of it and throws
/// std::runtime_error for what it cannot use. The checksum is looked at before; what was decoded
/// counts only if nothing is refused. Throws std::bad_alloc, and what else `decode` throws.
std::optional<EntryRefusal> read_entry(const std::filesystem::path& file, const ArtefactKey& key,
                                       EntryHeader& header,
                                       const std::function<void(ArtefactReader&)>& decode);

}  // namespace lacuna
