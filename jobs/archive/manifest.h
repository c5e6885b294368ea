#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "base/settings/field.h"
#include "jobs/store/inputs.h"

namespace lacuna {

/// A file of an archive.
struct ArchivedFile {
  std::string name;  ///< relative, separated by '/'
  std::uint64_t bytes = 0;
  std::string hash;
  bool operator==(const ArchivedFile&) const = default;
};
template <class V>
void describe(V& v, ArchivedFile& s) {
  v("name", s.name,
    {.doc = "relative path in the archive", .min = 1, .max = 4096, .required = true});
  v("bytes", s.bytes, {.doc = "its size", .required = true, .unit = "bytes"});
  v("hash", s.hash, {.doc = "XXH3-64 of its content", .min = 16, .max = 16, .required = true});
}

/// The last error of a run that was done.
struct ArchivedRun {
  std::string name;
  std::uint64_t cell = 0;
  std::optional<double> seconds, cpu_seconds, error;
  bool operator==(const ArchivedRun&) const = default;
};
template <class V>
void describe(V& v, ArchivedRun& s) {
  v("name", s.name, {.doc = "name of the run", .min = 1, .max = 100, .required = true});
  v("cell", s.cell, {.doc = "its cell, from 1", .min = 1, .required = true});
  v("seconds", s.seconds, {.doc = "render time, wall clock", .unit = "s"});
  v("cpu_seconds", s.cpu_seconds,
    {.doc = "render time, CPU seconds divided by threads", .unit = "s"});
  v("error", s.error, {.doc = "its error at the end"});
}

/// manifest.json of an archive: what it contains and how it was made.
struct Manifest {
  std::string version, created, processor, metric;
  int cores = 0;
  std::vector<ArchivedFile> files;
  InputList left_out;
  std::vector<ArchivedRun> runs;
  bool operator==(const Manifest&) const = default;
};
template <class V>
void describe(V& v, Manifest& s) {
  v("version", s.version, {.doc = "of Lacuna", .max = 200, .required = true});
  v("created", s.created, {.doc = "UTC, ISO 8601", .max = 64, .required = true});
  v("processor", s.processor, {.doc = "of the machine that made the archive", .max = 200});
  v("cores", s.cores, {.doc = "its hardware threads", .min = 0});
  v("metric", s.metric, {.doc = "the error of `runs`", .max = 64});
  v("files", s.files,
    {.doc = "all other files, without reproduce.sh", .max = 1e6, .required = true});
  v("left_out", s.left_out, {.doc = "inputs of which only the hash is kept", .max = 1e6});
  v("runs", s.runs, {.doc = "the runs that were done", .max = 1e5});
}

}  // namespace lacuna
