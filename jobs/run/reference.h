#pragma once

#include <optional>
#include <string>
#include <vector>

#include "jobs/spec/job_spec.h"
#include "jobs/store/job_folder.h"

namespace lacuna {

/// What a job's error is measured against.
struct Reference {
  std::string name;
  std::vector<double> rgb;          ///< interleaved, top row first, of the job's resolution
  std::optional<double> mse;        ///< its own remaining noise, if it is known
  std::filesystem::path file = {};  ///< where it was read from
};

/// Reads the picture that `spec.reference` names (not "auto" or empty): an EXR or a TIFF of floats
/// below a scenes root, a job's id, or the name of a folder below the references. Throws
/// SceneError: not there, unfinished, or of another size.
Reference find_reference(const JobSpec& spec, const DataRoot& data, const ScenesRoots& scenes);

/// Reads `image` (an image.exr of ours, or anybody's EXR). Throws SceneError, also on another size
/// than `resolution` or a value that is not finite.
Reference read_reference(const std::string& name, const std::filesystem::path& image,
                         const std::array<int, 2>& resolution);

/// The job that makes the "auto" reference of `spec` (reference_spec()), and its folder below the
/// references, named by what it depends on: this job, and `content` (hashes of the scene and of the
/// environment).
struct ReferenceJob {
  JobSpec spec;
  JobFolder folder;
};
ReferenceJob auto_reference(const JobSpec& spec, const DataRoot& data, const std::string& content);

}  // namespace lacuna
