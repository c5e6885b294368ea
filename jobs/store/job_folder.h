#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "base/storage/file_lock.h"
#include "jobs/spec/job_spec.h"
#include "jobs/store/acceptance.h"
#include "jobs/store/state.h"

namespace lacuna {

/// progress.json: progress for display, updated several times a second. Written without fsync.
struct Progress {
  std::int64_t iteration = 0;
  double seconds = 0;      ///< render time so far, wall clock
  double cpu_seconds = 0;  ///< render time so far, CPU seconds / threads
  double share = 0;        ///< of the budget, [0, 1]
  std::optional<double> remaining_seconds;
  std::optional<double> error;  ///< latest value of `error_metric`
  std::string error_metric;
  bool operator==(const Progress&) const = default;
};
template <class V>
void describe(V& v, Progress& s) {
  v("iteration", s.iteration, {.doc = "iterations done", .min = 0, .required = true});
  v("seconds", s.seconds, {.doc = "render time so far, wall clock", .unit = "s"});
  v("cpu_seconds", s.cpu_seconds, {.doc = "render time so far, CPU time / threads", .unit = "s"});
  v("share", s.share, {.doc = "of the budget, 0 to 1"});
  v("remaining_seconds", s.remaining_seconds, {.doc = "estimate of what remains", .unit = "s"});
  v("error", s.error, {.doc = "latest value of error_metric"});
  v("error_metric", s.error_metric, {.doc = "which error"});
}

/// The files of a job's folder. No other file is served.
struct FileInfo {
  std::string_view name;
  std::string_view media_type;
  std::string_view doc;
  bool served;  ///< over HTTP
};
const std::vector<FileInfo>& job_files();

/// One job's folder (docs/jobs.md). Cheap to copy: only a path.
class JobFolder {
 public:
  explicit JobFolder(std::filesystem::path dir) : dir_(std::move(dir)) {}
  const std::filesystem::path& dir() const { return dir_; }
  std::string id() const { return dir_.filename().string(); }
  std::filesystem::path file(std::string_view name) const { return dir_ / name; }

  /// Creates the folder with job.json atomically: synced under a temporary name, then renamed.
  /// Throws std::system_error; std::invalid_argument if `dir` exists.
  static JobFolder create(const std::filesystem::path& dir, const JobSpec& spec);

  JobSpec read_job() const;           ///< throws BadJob, std::system_error
  std::string read_job_text() const;  ///< the input of read_job(); same exceptions
  /// outcome.json, which renderers write; `queued` if none has begun. Throws std::system_error, and
  /// std::runtime_error if it is corrupt.
  JobState read_state() const;
  void write_job(const JobSpec& spec) const;  ///< synced
  void write_state(const JobState& s, bool synced = true) const;
  /// Changes the state of a job that has ended to queued; requires its lock. Throws the exceptions
  /// of read_state() and write_state().
  void reopen() const;
  Acceptance read_acceptance()
      const;  ///< all defaults if missing; throws std::runtime_error if corrupt
  void write_acceptance(const Acceptance& a) const;  ///< not synced: the database has it too
  std::optional<Progress> read_progress() const;
  void write_progress(const Progress& p) const;

  /// Locks the folder for this process during the life of the object, so that only one renderer
  /// writes into it. None if another process has the lock. Also removes the temporary files of
  /// killed renderers. Throws std::system_error.
  using Lock = FileLock;
  std::optional<Lock> try_lock() const;

 private:
  std::filesystem::path dir_;
};

/// The data folder of a service or a user, and the folders below it.
struct DataRoot {
  std::filesystem::path dir;
  std::filesystem::path cache_folder = {};              ///< empty: `cache` below `dir`
  std::uint64_t cache_limit = std::uint64_t{10} << 30;  ///< bytes, of all artefacts together

  std::filesystem::path jobs() const { return dir / "jobs"; }
  std::filesystem::path sweeps() const { return dir / "sweeps"; }
  std::filesystem::path references() const { return dir / "references"; }
  /// Of the artefacts.
  std::filesystem::path cache() const {
    return cache_folder.empty() ? dir / "cache" : cache_folder;
  }

  /// $LACUNA_DATA, or `lacuna-data` in the working directory; the cache as in at().
  static DataRoot from_environment();
  /// `dir`, with the cache's folder and limit from $LACUNA_CACHE and $LACUNA_CACHE_LIMIT if they
  /// are set. All paths become absolute. Throws std::invalid_argument for an invalid limit.
  static DataRoot at(const std::filesystem::path& dir);
};

/// Folders that scene, image and environment names are looked up in, in order. $LACUNA_SCENES
/// (separated by ':'), or the built-in `jobs/scenes`.
class ScenesRoots {
 public:
  explicit ScenesRoots(std::vector<std::filesystem::path> roots) : roots_(std::move(roots)) {}
  /// $LACUNA_SCENES if set, else `jobs/scenes` in the working directory, then those installed with
  /// this program or, if it is not installed, in its source tree.
  static ScenesRoots from_environment();
  const std::vector<std::filesystem::path>& roots() const { return roots_; }

  /// The regular file named `name`: a relative path, separated by '/', that cannot leave its root,
  /// nor through a symbolic link. `extensions` include the dot (".glb"); case does not matter.
  /// Throws std::invalid_argument with the reason and the available names, and InputUnreadable if
  /// its existence cannot be determined now: it cannot be examined (no permission or descriptor, a
  /// failing disk), or no root has it and one is missing or empty.
  std::filesystem::path resolve(std::string_view name,
                                const std::vector<std::string_view>& extensions) const;

  /// Names of all scenes (.glb, .gltf) below the roots, sorted: four folders deep, among the first
  /// 10,000 entries of each root, without hidden files and without following links.
  std::vector<std::string> list() const;

 private:
  std::vector<std::filesystem::path> roots_;
};

/// Extensions of the files that a job can name.
inline const std::vector<std::string_view> scene_extensions{".glb", ".gltf"};
inline const std::vector<std::string_view> environment_extensions{".exr", ".hdr"};

/// A new job id: UTC time and random letters ("20260131-235959-k3x9qa"): sorts by time, safe as a
/// file name.
std::string new_job_id();
/// Whether `s` has the form of new_job_id(); no other name is looked up on disk.
bool is_job_id(std::string_view s);
/// The id of the job of a sweep's run: the sweep's id with its letters, a number in base 36,
/// increased by 1 + `index` (modulo 36^6). A pure function, so the mapping need not be stored.
std::string run_job_id(std::string_view sweep_id, std::size_t index);
/// The inverse of run_job_id(), for any index, whether or not the sweep has such a run; none if
/// `job_id` does not have that form.
std::optional<std::size_t> run_index(std::string_view sweep_id, std::string_view job_id);
/// Names of all folders below `jobs` that have the form of an id, oldest first. Does not open them.
std::vector<std::string> list_job_names(const std::filesystem::path& jobs);
/// Whether the folder contains a job; true, too, if this cannot be determined now.
bool is_job(const JobFolder& folder);
/// All jobs below `jobs`, oldest first, without other folders.
std::vector<JobFolder> list_jobs(const std::filesystem::path& jobs);
/// A time as in JobState: UTC, ISO 8601 with milliseconds; such texts sort by time.
std::string utc_text(std::chrono::system_clock::time_point time);
/// Now.
std::string utc_now();

}  // namespace lacuna
