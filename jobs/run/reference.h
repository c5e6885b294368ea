#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/storage/input_file.h"
#include "jobs/spec/job_spec.h"
#include "jobs/store/job_folder.h"

namespace lacuna {

/// The reference image of a job, which its errors are measured against.
struct Reference {
  std::string name;
  std::vector<double> rgb;          ///< interleaved, top row first, of the job's resolution
  std::optional<double> mse;        ///< estimate of its own noise, if known
  std::filesystem::path file = {};  ///< where it was read from
  InputFile input = {};             ///< that file as it was read
};

/// The picture that a job names as its reference (not "auto" or empty): an EXR, Radiance HDR, PFM
/// or TIFF of floats below a scenes root, a job's id, or the name of a folder below the references.
/// Throws SceneError if it is missing, which calls it `what`; InputUnreadable.
std::filesystem::path reference_file(const std::string& name, const DataRoot& data,
                                     const ScenesRoots& scenes,
                                     std::string_view what = "reference");

/// Reads reference_file() of `spec.reference`. Throws SceneError if it is missing, unfinished, or
/// of another size; InputUnreadable.
Reference find_reference(const JobSpec& spec, const DataRoot& data, const ScenesRoots& scenes);

/// Reads the file `image`, the image.exr of a job or another EXR. Throws SceneError, also if its
/// size is not `resolution` or a value is not finite; InputUnreadable.
Reference read_reference(const std::string& name, const std::filesystem::path& image,
                         const std::array<int, 2>& resolution);

/// The job that renders an "auto" reference.
struct ReferenceJob {
  JobSpec spec;
  JobFolder folder;
};
/// The job that renders the "auto" reference of `spec` (reference_spec()). The name of its folder
/// is a hash of that job and of `content`, the hashes of the scene and the environment.
ReferenceJob auto_reference(const JobSpec& spec, const DataRoot& data, const std::string& content);

}  // namespace lacuna
