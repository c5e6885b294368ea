#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "jobs/run/budget.h"
#include "jobs/run/curve.h"
#include "jobs/run/iteration_set.h"
#include "renderer/film/film.h"
#include "renderer/film/layer_means.h"

namespace lacuna {

/// The wall seconds of each phase of a job, for the report. They include earlier processes up to
/// the checkpoint from which this one continues.
using PhaseSeconds = std::map<std::string, double>;

/// Statistics of a picture merged from shards.
struct MergedShards {
  std::uint32_t shards = 0;      ///< 0: not merged
  std::uint64_t iterations = 0;  ///< of all shards together
  /// The sum of n_k |x_k - x|^2 over the shards, with n_k iterations and mean x_k each, x the mean
  /// of all; the mean over pixels and channels. Its expectation is (shards - 1) s^2, with s^2 the
  /// variance of an iteration.
  double between = 0;
  std::uint8_t learned = 0;  ///< 1: each shard learned only from its own iterations
};

/// RMSE of the merged picture, from the spread of its shards; none with fewer than two. Unlike the
/// two halves, shards are independent also where iterations learn from those before them.
std::optional<double> estimated_rmse(const MergedShards& merged);

/// The budget of a job or shard; a shard has its part of the iterations. Throws BadJob if it is 0.
Budget budget_of(const JobSpec& spec);

/// The content of a checkpoint, except the integrator's learned state.
struct RunState {
  /// The state of a shard, or of the whole job, before its first iteration. `layer_names`: the
  /// integrator's own layers. Throws MemoryLimitError if the layers would take more than
  /// `byte_limit`.
  RunState(const JobSpec& spec, const std::vector<std::string>& layer_names,
           std::uint64_t byte_limit);

  Film film;
  IterationSet done;
  Spent spent;  ///< when the last finished iteration ended
  LayerMeans layers;
  Counters counters;
  Curve curve;
  std::uint64_t refused_rays = 0;  ///< of earlier processes
  PhaseSeconds phases;             ///< likewise
  MergedShards merged;

  /// `refused`, `seconds`: including this process. `learned_bytes`: size of the integrator's
  /// learned state, which follows. load() throws std::runtime_error on data that save() never
  /// writes, also if parts contradict each other, which a checksum does not detect.
  void save(ByteWriter& out, std::uint64_t refused, const PhaseSeconds& seconds,
            std::uint64_t learned_bytes) const;
  void load(ByteReader& in);
};

}  // namespace lacuna
