#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>

#include "jobs/run/budget.h"
#include "jobs/run/clock.h"
#include "jobs/run/curve.h"
#include "jobs/run/observer.h"
#include "jobs/run/reference.h"
#include "jobs/spec/job_spec.h"
#include "jobs/store/job_folder.h"
#include "renderer/film/film.h"
#include "renderer/film/layer_means.h"
#include "renderer/integrators/integrator.h"

namespace lacuna {

/// The wall seconds of each phase of a job, for the report: of this process, and of those before it
/// up to the checkpoint it went on from.
using PhaseSeconds = std::map<std::string, double>;

/// What the loop works on. All references outlive it.
struct RenderTask {
  const JobFolder& folder;
  const JobSpec& spec;
  const Scene& scene;
  const Camera& camera;
  const ThreadPool& pool;
  Integrator& integrator;
  const Reference* reference;                ///< may be null
  const std::function<bool()>& interrupted;  ///< from a signal: true asks the loop to stop
  Observer& observer;
  PhaseSeconds& phases;
  std::string content;  ///< hashes of the files the picture depends on
};

/// A picture in the making: iterations until the budget is spent, rows of the curve at log-spaced
/// instants, checkpoints, progress. The render clock runs only during iterations.
class RenderLoop {
 public:
  /// The integrator is prepared. Throws MemoryLimitError where it would fill more layers than
  /// memory holds.
  explicit RenderLoop(const RenderTask& task);

  /// Goes on from the folder's checkpoint, if it has one of this picture. A damaged one is reported
  /// to the observer, kept under another name, and the picture begins anew.
  void resume();

  /// True: the budget is spent; the checkpoint holds this very end, so that a larger budget can go
  /// on from it. False: interrupted; a checkpoint was written.
  bool run();

  const Film& film() const { return film_; }
  /// What the integrator filled beside the picture.
  const LayerMeans& layers() const { return layers_; }
  const Curve& curve() const { return curve_; }
  const Counters& counters() const { return counters_; }
  Spent spent() const { return completed_; }
  std::uint64_t refused_rays() const;  ///< as RayCaster counts them, since the job began

 private:
  /// What a checkpoint must agree with to be gone on from. The integrator's own layers are means
  /// over all iterations, so they are part of it: where a job file came to ask for others, the
  /// picture begins anew. All other layers are made at the end, and may change at any time.
  std::string identity() const;
  bool iterate();
  void add_row();
  void write_checkpoint_now();
  void write_last_checkpoint();
  void save_phases(ByteWriter& out) const;
  static PhaseSeconds load_phases(ByteReader& in);
  void write_preview_now();
  void report_progress();

  RenderTask task_;
  Budget budget_;
  Film film_;
  Image frame_;
  LayerMeans layers_;
  Curve curve_;
  Counters counters_;
  std::uint64_t refused_before_ = 0;  // by processes before this one
  std::uint64_t saved_ = 0;           // iterations in the checkpoint
  bool floor_told_ = false;           // that the reference bounds the errors
  RenderClock clock_;
  Spent completed_;  // when the last finished iteration ended
  Pace checkpoints_, previews_, progress_;
};

}  // namespace lacuna
