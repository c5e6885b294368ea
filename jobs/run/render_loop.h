#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "base/parallel/stop.h"
#include "jobs/run/clock.h"
#include "jobs/run/merge_shards.h"
#include "jobs/run/observer.h"
#include "jobs/run/reference.h"
#include "jobs/run/run_state.h"
#include "renderer/film/flip.h"
#include "renderer/integrators/integrator.h"

namespace lacuna {

/// The input of RenderLoop. All referenced objects outlive it.
struct RenderTask {
  const JobFolder& folder;
  const JobSpec& spec;
  const Scene& scene;
  const Camera& camera;
  const ThreadPool& pool;
  Integrator& integrator;
  const Reference* reference;                ///< may be null
  const std::function<bool()>& interrupted;  ///< true: a signal requests a stop
  Observer& observer;
  PhaseSeconds& phases;
  std::string content;  ///< hashes of the files the picture depends on
  /// Once interrupted() is true: the seconds left to write the checkpoint. Empty: no limit.
  std::function<double()> seconds_left = {};

  /// Throws Stopped if the task was interrupted and has no seconds left. Called during long writes.
  void stop_if_late() const {
    if (seconds_left && interrupted() && seconds_left() <= 0) throw Stopped{};
  }
};

/// Renders iterations until the budget is spent, and writes rows of the curve at log-spaced
/// instants, checkpoints, previews and progress. The render clock runs only during iterations.
class RenderLoop {
 public:
  /// The task's integrator must be prepared. Throws MemoryLimitError if its layers do not fit into
  /// memory.
  explicit RenderLoop(const RenderTask& task);

  /// Continues from the folder's checkpoint, if there is one of this picture. A damaged checkpoint
  /// is reported to the observer and renamed, and rendering starts from the first iteration. Throws
  /// Stopped if it is interrupted while reading a large one.
  void resume();

  /// Instead of resume(): begins with the merged shards of the job, all of them in order; run()
  /// then only finishes the job. Throws the exceptions of merge_shards(), and Stopped if it is
  /// interrupted: the next attempt merges from the beginning.
  void merge(const std::vector<Shard>& shards);

  /// Instead of resume(), if the folder has no checkpoint: begins with the checkpoint of the job
  /// `other` of the same picture, if it has one. `elsewhere`: the cost of other pictures, which
  /// counts as spent on this one.
  void begin_from(const JobFolder& other, const Spent& elsewhere);

  enum class End { spent, interrupted, no_iteration };
  /// Renders until the budget is spent; the checkpoint then holds the final state, so that the job
  /// can continue with a larger budget. Or until it is interrupted: a checkpoint was written if
  /// time was left.
  End run();
  /// Renders until `part` of the budget is spent. Abandons no iteration, except a first one that
  /// exceeds `limit`, if given: no_iteration.
  End run_part(const Budget& part, const std::optional<Budget>& limit);
  /// Number of iterations not yet in a checkpoint.
  std::uint64_t unsaved_iterations() const { return state_.spent.iterations - saved_.iterations; }

  const Film& film() const { return state_.film; }
  /// The means of the integrator's own layers, and of the layers of light.
  const LayerMeans& layers() const { return state_.layers; }
  const Curve& curve() const { return state_.curve; }
  const Counters& counters() const { return state_.counters; }
  Spent spent() const { return state_.spent; }
  /// spent() plus the cost of abandoned iterations.
  Spent elapsed() const;
  const MergedShards& merged() const { return state_.merged; }
  /// Whether this number of iterations on one machine gives the same bits: always, unless a merged
  /// picture learned in its shards, has a gap, or rounded a sum.
  bool same_bits_as_one() const;
  std::uint64_t refused_rays() const;  ///< as counted by RayCaster, for the whole job

 private:
  std::vector<std::string> layer_names();
  std::string identity() const;
  /// `late`: whether the present iteration takes too long.
  End run_until(const Budget& budget, const std::function<bool()>& late);
  bool iterate(const std::function<bool()>& late);
  /// Loads the checkpoint of `folder`; false if there is none, or if it is unusable and was
  /// renamed.
  bool load(const JobFolder& folder);
  void count_phases();
  /// `last`: with all errors, whatever they cost.
  void add_row(bool last = false);
  /// FLIP of the film; none if it is not due, or interrupted.
  std::optional<double> measure_flip(bool last);
  /// False if interrupted without seconds left; the previous checkpoint remains.
  bool write_checkpoint_now();
  bool write_last_checkpoint();
  void write_preview_now();
  void report_progress(const Spent& spent);
  void stop_if_interrupted() const;

  RenderTask task_;
  Budget budget_;
  LightLayers light_;
  std::size_t own_layers_ = 0;  // of the integrator: those of light_ follow them
  RunState state_;
  Image frame_;
  bool merging_ = false;     // run() renders nothing
  Spent saved_;              // in the checkpoint
  bool floor_told_ = false;  // whether the warning of the reference's noise was given
  RenderClock clock_;
  Pace checkpoints_, previews_, progress_, flips_;
  std::optional<FlipExposures> flip_exposures_;  // of the reference
};

}  // namespace lacuna
