#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/storage/input_file.h"
#include "jobs/store/job_folder.h"

namespace lacuna {

template <class V>
void describe(V& v, InputFile& s) {
  v("role", s.role, {.doc = "role of the file", .required = true});
  v("name", s.name, {.doc = "name in the job, or in the scene", .required = true});
  v("bytes", s.bytes, {.doc = "its size", .required = true, .unit = "bytes"});
  v("hash", s.hash, {.doc = "XXH3-64 of its content", .max = 16, .required = true});
}

/// All input files of a result, the scene first.
using InputList = std::vector<InputFile>;

/// inputs.json of a job's folder; none if it is missing, as in folders of older builds. Throws
/// std::system_error, and std::runtime_error if it is corrupt.
std::optional<InputList> read_inputs(const JobFolder& folder);
void write_inputs(const JobFolder& folder, const InputList& inputs);  ///< synced

/// The name of a file in messages: `texture "tex/a.png"`.
std::string input_text(const InputFile& file);

/// Compares two lists: the differences of `now`, one line per file of either list, identified by
/// role and name; empty: none.
std::vector<std::string> changed_inputs(const InputList& before, const InputList& now);

}  // namespace lacuna
