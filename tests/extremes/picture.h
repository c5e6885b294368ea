#pragma once

#include <array>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "jobs/run/run_job.h"
#include "renderer/film/film.h"
#include "renderer/path/counters.h"
#include "tests/block_means.h"
#include "tests/extremes/methods.h"
#include "tests/extremes/scenes.h"
#include "tests/jobs/run/silent_observer.h"
#include "tests/temporary_folder.h"

namespace lacuna::extremes {

/// A picture, and each iteration's block_means().
struct Picture {
  Film film;
  Counters counters;
  std::vector<std::vector<double>> blocks;
};

/// How long and how large everything is: in every run of the tests, or in a run of its own.
struct Effort {
  bool quick = true;
  int side() const { return quick ? 16 : 32; }        ///< pixels
  int iterations() const { return quick ? 16 : 64; }  ///< of an ordinary picture
  int resolution() const { return quick ? 24 : 64; }  ///< voxels
};

/// Where jobs are done: scenes, a data root, threads.
class Stage {
 public:
  explicit Stage(Effort effort) : effort_(effort) {}

  const Effort& effort() const { return effort_; }
  /// Puts a scene where jobs find it, once for each name.
  const std::string& scene(const std::string& name, const std::function<Bytes()>& make);
  /// A job of ordinary size.
  JobSpec job(const Method& method, const std::string& scene) const;
  /// The picture after the job's iterations, in this process, without any file. Throws what a job
  /// would.
  Picture render(const JobSpec& job);
  /// EmitterSet::texels_read() of the job's scene; 0: the job needs no emitters.
  std::uint64_t texels_read(const JobSpec& job);
  /// Calls `see` with each iteration's estimate of the whole picture.
  Counters iterate(const JobSpec& job, const std::function<void(const Image&)>& see);
  /// The picture of room({}) by a method of this name, made once.
  const Picture& plain(const Method& method);

  /// Does the whole job; `interrupted` is asked as by run_job. The folder stays until the next.
  JobFolder run(const JobSpec& job, const std::function<bool()>& interrupted);
  /// Runs the same folder once more.
  Outcome go_on(const JobFolder& folder);
  /// Where jobs find a file of this name.
  std::filesystem::path file(const std::string& name) const { return folder_ / name; }

 private:
  RunContext context(const std::function<bool()>& interrupted);

  Effort effort_;
  TemporaryFolder folder_;
  SilentObserver observer_;
  std::map<std::string, std::string> scenes_;
  std::map<std::string, Picture> plain_;
};

}  // namespace lacuna::extremes
