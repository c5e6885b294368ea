#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "jobs/store/job_folder.h"
#include "jobs/sweep/sweep_folder.h"

namespace lacuna {

struct PackOptions {
  std::vector<std::string> leave_out;  ///< patterns (fnmatch) of input files to keep as hashes only
  bool pictures = true;                ///< with the image.exr of each run
};

/// What an archive contains, for a person.
struct PackSummary {
  std::size_t runs = 0, files = 0, left_out = 0;
  std::vector<std::string> warnings;
};

/// Writes all that is needed to repeat a sweep into `out` (.tar.zst): sweep.json, the folders of
/// the runs that are done, their input files, references, manifest.json and reproduce.sh. All names
/// begin with the stem of `out`. Throws BadJob if no run is done, or if an input is missing or has
/// changed since its run; the exceptions of answer() and TarWriter.
PackSummary pack_sweep(const SweepFolder& sweep, const DataRoot& data, const ScenesRoots& scenes,
                       const PackOptions& options, const std::filesystem::path& out);

}  // namespace lacuna
