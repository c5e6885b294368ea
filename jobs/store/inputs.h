#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/storage/input_file.h"
#include "jobs/store/job_folder.h"

namespace lacuna {

template <class V>
void describe(V& v, InputFile& s) {
  v("role", s.role, {.doc = "what the file is to the job", .required = true});
  v("name", s.name, {.doc = "as the job names it, or the scene", .required = true});
  v("bytes", s.bytes, {.doc = "its size", .required = true, .unit = "bytes"});
  v("hash", s.hash, {.doc = "XXH3-64 of its content", .max = 16, .required = true});
}

/// All files that a result was made from, the scene first.
using InputList = std::vector<InputFile>;

/// inputs.json of a job's folder; nothing if there is none, as in folders of older builds. Throws
/// std::system_error, and std::runtime_error if it is corrupt.
std::optional<InputList> read_inputs(const JobFolder& folder);
void write_inputs(const JobFolder& folder, const InputList& inputs);  ///< synced

/// A file as messages name it: `texture "tex/a.png"`.
std::string input_text(const InputFile& file);

/// The one comparison of two such lists: what is different in `now`, a line for each file of both
/// lists, by their roles and names; empty: nothing.
std::vector<std::string> changed_inputs(const InputList& before, const InputList& now);

}  // namespace lacuna
