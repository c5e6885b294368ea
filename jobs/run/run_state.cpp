#include "jobs/run/run_state.h"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

#include "jobs/spec/job_json.h"
#include "jobs/spec/problems.h"

namespace lacuna {

namespace {

bool is_time(double t) { return std::isfinite(t) && t >= 0; }

IterationSet iterations_of(const JobSpec& spec) {
  if (spec.shard == 0 || spec.shards == 1) return {};
  return {static_cast<std::uint32_t>(spec.shards), static_cast<std::uint32_t>(spec.shard - 1)};
}

void save_phases(ByteWriter& out, const PhaseSeconds& phases) {
  out.put(static_cast<std::uint64_t>(phases.size()));
  for (const auto& [name, seconds] : phases) {
    out.put(std::string_view(name));
    out.put(seconds);
  }
}

PhaseSeconds load_phases(ByteReader& in) {
  PhaseSeconds phases;
  for (auto n = in.get<std::uint64_t>(); n > 0; --n) {
    const std::string name = in.get_string();
    const auto seconds = in.get<double>();
    const bool follows = phases.empty() || phases.rbegin()->first < name;
    if (!follows || !is_time(seconds)) throw std::runtime_error("saved phases are invalid");
    phases[name] = seconds;
  }
  return phases;
}

}  // namespace

Budget budget_of(const JobSpec& spec) {
  Budget budget = spec.budget;
  const IterationSet own = iterations_of(spec);
  if (own.is_whole()) return budget;
  const std::int64_t all = budget.iterations.value_or(std::int64_t{max_iterations});
  budget.iterations = static_cast<std::int64_t>(own.count_below(static_cast<std::uint64_t>(all)));
  if (*budget.iterations > 0) return budget;
  throw BadJob({{"/shards", fmt::format("shard {} of {} has none of {} iterations, which are "
                                        "distributed in pairs; allowed: 1 to {} shards",
                                        spec.shard, spec.shards, all, most_shards(all))}});
}

std::optional<double> estimated_rmse(const MergedShards& merged) {
  if (merged.shards < 2 || merged.iterations == 0) return std::nullopt;
  return std::sqrt(merged.between / (merged.shards - 1.0) / static_cast<double>(merged.iterations));
}

RunState::RunState(const JobSpec& spec, const std::vector<std::string>& layer_names,
                   std::uint64_t byte_limit)
    : film(spec.resolution[0], spec.resolution[1]),
      done(iterations_of(spec)),
      layers(layer_names, spec.resolution[0], spec.resolution[1], byte_limit) {}

void RunState::save(ByteWriter& out, std::uint64_t refused, const PhaseSeconds& seconds,
                    std::uint64_t learned_bytes) const {
  film.save(out);
  done.save(out);
  out.put(spent);
  layers.save(out);
  out.put(counters);
  curve.save(out);
  out.put(refused);
  out.put(merged.shards);
  out.put(merged.iterations);
  out.put(merged.between);
  out.put(merged.learned);
  save_phases(out, seconds);
  out.put(learned_bytes);
}

void RunState::load(ByteReader& in) {
  const IterationSet own = done;
  film.load(in);
  done.load(in);
  spent = in.get<Spent>();
  layers.load(in, spent.iterations);
  counters = in.get<Counters>();
  curve.load(in);
  refused_rays = in.get<std::uint64_t>();
  merged.shards = in.get<std::uint32_t>();
  merged.iterations = in.get<std::uint64_t>();
  merged.between = in.get<double>();
  merged.learned = in.get<std::uint8_t>();
  phases = load_phases(in);
  if (in.get<std::uint64_t>() != in.remaining()) {
    throw std::runtime_error("saved state of the integrator has the wrong size");
  }
  if (!done.serves(own)) throw std::runtime_error("saved iterations belong to another shard");
  if (film.iterations() != spent.iterations || film.iterations() != done.count() ||
      film.half_iterations(0) != done.count_even()) {
    throw std::runtime_error("saved film has the wrong number of iterations");
  }
  if (!is_time(spent.seconds) || !is_time(spent.cpu_seconds) || !is_time(spent.longest_seconds)) {
    throw std::runtime_error("saved times are invalid");
  }
  if (merged.learned > 1 || !is_time(merged.between)) {
    throw std::runtime_error("saved shards are invalid");
  }
}

}  // namespace lacuna
