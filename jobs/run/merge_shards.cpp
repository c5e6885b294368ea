#include "jobs/run/merge_shards.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <system_error>

#include "jobs/run/checkpoint.h"

namespace lacuna {

namespace {

struct Loaded {
  RunState state;
  std::string learned;
};

Loaded load(const Shard& shard, const std::string& key, const std::vector<std::string>& layers) {
  const auto file = shard.folder.file("checkpoint.bin");
  try {
    const auto content = read_checkpoint(file, key);
    if (!content) throw std::runtime_error(fmt::format("{} is missing", file.string()));
    ByteReader in(*content);
    Loaded loaded{{shard.spec, layers, std::numeric_limits<std::uint64_t>::max()}, {}};
    loaded.state.load(in);
    loaded.learned = in.get_text();
    if (!in.at_end()) throw std::runtime_error("saved state has extra bytes at its end");
    if (loaded.state.film.iterations() != shard.iterations) {
      throw std::runtime_error(
          fmt::format("{} has {} iterations, its report {}: it could not be written at the end",
                      file.string(), loaded.state.film.iterations(), shard.iterations));
    }
    return loaded;
  } catch (const std::system_error&) {
    throw;  // another time it may be read
  } catch (const std::runtime_error& e) {
    throw std::runtime_error(fmt::format("shard {} of {} ({}): {}", shard.spec.shard,
                                         shard.spec.shards, shard.folder.dir().string(), e.what()));
  }
}

/// Deviations of the union of two sets of iterations (Chan, Golub and LeVeque 1979).
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

std::string merge_shards(const std::vector<Shard>& shards, const std::string& key, RunState& state,
                         const std::function<void()>& after_each) {
  std::string learned;
  std::uint64_t most = 0;
  for (const Shard& shard : shards) {
    Loaded loaded = load(shard, key, state.layers.names());
    const std::uint64_t iterations = loaded.state.film.iterations();
    if (!loaded.learned.empty()) state.merged.learned = 1;
    if (iterations > most) {
      most = iterations;
      learned = std::move(loaded.learned);
    }
    if (state.merged.shards == 0) {
      state.done = IterationSet(static_cast<std::uint32_t>(shard.spec.shards), 0);
      state.curve = loaded.state.curve;
    }
    add(state, loaded.state);
    after_each();
  }
  state.done.simplify();
  return learned;
}

}  // namespace lacuna
