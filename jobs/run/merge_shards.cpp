#include "jobs/run/merge_shards.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <system_error>

namespace lacuna {

namespace {

/// Loads the state of `shard`; `learned` reads its integrator's learned state.
RunState load(const Shard& shard, const std::string& key, const std::vector<std::string>& layers,
              const std::function<void(ByteReader&)>& learned, const BetweenPieces& between) {
  const auto file = shard.folder.file("checkpoint.bin");
  try {
    RunState state{shard.spec, layers, std::numeric_limits<std::uint64_t>::max()};
    const auto read = [&](ByteReader& in) {
      state.load(in);
      if (state.film.iterations() != shard.iterations) {
        throw std::runtime_error(fmt::format(
            "it has {} iterations and its report {}: the last checkpoint could not be written",
            state.film.iterations(), shard.iterations));
      }
      learned(in);
    };
    if (read_checkpoint(file, key, read, between)) return state;
    throw std::runtime_error(fmt::format("{} is missing", file.string()));
  } catch (const std::system_error&) {
    throw;  // transient
  } catch (const std::runtime_error& e) {
    throw std::runtime_error(fmt::format("shard {} of {} ({}): {}", shard.spec.shard,
                                         shard.spec.shards, shard.folder.dir().string(), e.what()));
  }
}

/// Adds the squared deviations of the union of two sets (Chan, Golub and LeVeque 1979).
void add_spread(MergedShards& merged, const Film& film, const Film& shard) {
  const auto a = static_cast<double>(film.iterations()),
             b = static_cast<double>(shard.iterations());
  if (a > 0 && b > 0) {
    merged.between += errors(film.mean(), shard.mean())[ErrorMetric::mse] * a * b / (a + b);
  }
  ++merged.shards;
  merged.iterations += shard.iterations();
}

void add(RunState& state, const RunState& shard) {
  add_spread(state.merged, state.film, shard.film);
  state.film.merge(shard.film);
  state.done.merge(shard.done);
  state.layers.merge(shard.layers);
  state.counters += shard.counters;
  state.refused_rays += shard.refused_rays;
  for (const auto& [name, seconds] : shard.phases) state.phases[name] += seconds;
  state.spent.iterations += shard.spent.iterations;
  state.spent.seconds += shard.spent.seconds;
  state.spent.cpu_seconds += shard.spent.cpu_seconds;
  state.spent.longest_seconds = std::max(state.spent.longest_seconds, shard.spent.longest_seconds);
}

}  // namespace

void merge_shards(const std::vector<Shard>& shards, const std::string& key, RunState& state,
                  const MergeCallbacks& callbacks) {
  const auto most =
      std::max_element(shards.begin(), shards.end(),
                       [](const Shard& a, const Shard& b) { return a.iterations < b.iterations; });
  for (auto shard = shards.begin(); shard != shards.end(); ++shard) {
    const auto learned = [&](ByteReader& in) {
      if (!in.at_end()) state.merged.learned = 1;
      if (shard == most) {
        callbacks.load_learned(in);
      } else {
        in.skip();
      }
    };
    const RunState loaded =
        load(*shard, key, state.layers.names(), learned, callbacks.between_pieces);
    if (state.merged.shards == 0) {
      state.done = IterationSet(static_cast<std::uint32_t>(shard->spec.shards), 0);
      state.curve = loaded.curve;
    }
    add(state, loaded);
    callbacks.after_each();
  }
  state.done.simplify();
}

}  // namespace lacuna
