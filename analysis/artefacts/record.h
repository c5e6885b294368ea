#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace lacuna {

/// What became of one request for an artefact, for a job's report.
struct ArtefactRecord {
  enum class Origin {
    built,       ///< made now
    loaded,      ///< read from the cache
    not_needed,  ///< nobody asked
  };
  std::string type;
  Origin origin = Origin::not_needed;
  double seconds = 0;            ///< of making or reading it; its inputs have records of their own
  double waited_seconds = 0;     ///< for another process that made it
  std::uint64_t disk_bytes = 0;  ///< of its entry; 0: it has none
  std::optional<std::uint64_t> content_bytes;  ///< of what it holds, in memory; if known
  std::string remark;  ///< why an entry was refused, or none was written; empty: all is well
  std::uint64_t peak_memory_bytes = 0;  ///< of the process, until it was there
};

}  // namespace lacuna
