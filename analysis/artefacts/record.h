#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace lacuna {

/// The outcome of one request for an artefact, for a job's report.
struct ArtefactRecord {
  enum class Origin {
    built,       ///< computed by this process
    loaded,      ///< read from the cache
    not_needed,  ///< never requested
  };
  std::string type;
  Origin origin = Origin::not_needed;
  double seconds = 0;  ///< to build or load it, without its inputs, which have their own records
  double waited_seconds = 0;                   ///< for another process that built it
  std::uint64_t disk_bytes = 0;                ///< of its cache entry; 0: none
  std::optional<std::uint64_t> content_bytes;  ///< uncompressed, if known
  std::string remark;  ///< why an entry was refused, or not written; empty: no problem
  std::uint64_t peak_memory_bytes = 0;  ///< of the process, up to the end of the request
};

}  // namespace lacuna
