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

/// The wall seconds of each phase of a job, for the report. They include those of earlier processes
/// up to the checkpoint from which this one continues.
using PhaseSeconds = std::map<std::string, double>;

/// The input of RenderLoop. All referenced objects outlive it.
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

/// Renders iterations until the budget is spent, and writes rows of the curve at log-spaced
/// instants, checkpoints, previews and progress. The render clock runs only during iterations.
class RenderLoop {
 public:
  /// The task's integrator must be prepared. Throws MemoryLimitError if its layers do not fit into
  /// memory.
  explicit RenderLoop(const RenderTask& task);

  /// Continues from the folder's checkpoint, if there is one of this picture. A damaged checkpoint
  /// is reported to the observer and renamed, and rendering starts from the first iteration.
  void resume();

  /// True: the budget is spent, and the checkpoint holds the final state, so that the job can
  /// continue with a larger budget. False: interrupted; a checkpoint was written.
  bool run();

  const Film& film() const { return film_; }
  /// The means of the integrator's own layers.
  const LayerMeans& layers() const { return layers_; }
  const Curve& curve() const { return curve_; }
  const Counters& counters() const { return counters_; }
  Spent spent() const { return completed_; }
  std::uint64_t refused_rays() const;  ///< as counted by RayCaster, of the whole job

 private:
  /// Identifies the picture: rendering continues only from a checkpoint with the same value. It
  /// includes the names of the integrator's own layers, which are means over all iterations. Other
  /// layers are rendered at the end, so they may change.
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
