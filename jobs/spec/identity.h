#pragma once

#include <array>
#include <concepts>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "jobs/spec/described_json.h"
#include "jobs/spec/job_spec.h"

namespace lacuna {

// The identities of a picture, a reference and a cold preparation: each is the whole job without a
// list of keys. A new key of a job belongs to all three unless it is listed here.

/// Names of keys of a table.
using KeyList = std::span<const std::string_view>;

/// The keys that do not change the bits of a job's estimate after a given number of iterations.
inline constexpr auto not_in_the_picture = std::to_array<std::string_view>({
    "label",                 // for people
    "budget",                // when to stop, not what is estimated
    "reference",             // what the estimate is compared with
    "reference_iterations",  // likewise
    "shards",                // iterations do not depend on who renders them
    "shard",                 // which iterations; checkpoints record theirs
    "threads",               // random numbers are counter-based
    "layers",                // filled in addition to the estimate; checkpoints record theirs
    "pixel_type",            // rounds the file, not the film
    "checkpoint_seconds",    // when to save
    "exclusive",             // what else runs meanwhile
});

/// The keys that do not change the quantity that a job estimates, and so its reference. `reference`
/// itself is not among them: errors against different references cannot be compared.
inline constexpr auto not_in_a_reference = std::to_array<std::string_view>({
    "label",                 // for people
    "integrator",            // how light is estimated; its path lengths count (LightLengths)
    "budget",                // when to stop
    "reference_iterations",  // how well the reference is known
    "analysis",              // guides the estimate; only false colours (inspect) show it
    "seed",                  // which random numbers
    "sampler",               // how they are spread
    "shards",                // who renders which iterations
    "shard",                 // likewise
    "threads",               // how many
    "layers",                // filled in addition to the estimate
    "pixel_type",            // rounds the file
    "checkpoint_seconds",    // when to save
    "exclusive",             // what else runs meanwhile
});

/// The path lengths that do not change the light that is estimated.
inline constexpr auto not_in_the_light = std::to_array<std::string_view>({
    "roulette_depth",  // ends paths at random, and weights those that go on
});

/// The keys that change neither the artefacts of the analysis of space, given the same needs, nor
/// the time they take. `threads` is not among them, nor are the keys that move the seeds of the
/// domain: camera, environment, particles.
inline constexpr auto not_in_a_preparation = std::to_array<std::string_view>({
    "label",                 // for people
    "resolution",            // of the picture; that of the analysis counts
    "crop",                  // likewise
    "integrator",            // which artefacts it needs is compared by their names (preparation())
    "budget",                // of the rendering
    "reference",             // read or rendered afterwards
    "reference_iterations",  // likewise
    "seed",                  // of the rendering's random numbers
    "sampler",               // likewise
    "shards",                // of the rendering's iterations
    "shard",                 // likewise
    "layers",                // of the picture
    "pixel_filter",          // likewise
    "pixel_type",            // likewise
    "checkpoint_seconds",    // of the rendering
    "exclusive",             // other load on the machine is reported (taint.h)
});

/// Hash of a written job without the keys `left_out`: 32 hexadecimal digits.
std::string hash_without(OrderedJson job, KeyList left_out);

/// Identifies the pixels: two jobs with the same value and iteration count have the same bits.
/// Guards checkpoints.
template <std::derived_from<JobSpec> Job>
std::string picture_key(const Job& job) {
  return hash_without(ObjectWriter::value_of(job), not_in_the_picture);
}

/// Identifies a cold preparation: jobs with the same value build equal artefacts of the same names.
template <std::derived_from<JobSpec> Job>
std::string preparation_key(const Job& job) {
  return hash_without(ObjectWriter::value_of(job), not_in_a_preparation);
}

/// The same settings with the keys `left_out` at their defaults. Throws BadJob for settings that
/// their own table does not allow.
template <Described T>
T without(const T& settings, KeyList left_out) {
  OrderedJson json = ObjectWriter::value_of(settings);
  for (const std::string_view key : left_out) json.erase(std::string(key));
  std::vector<Problem> problems;
  T rest{};
  read_settings(Json(json), problems, rest);
  if (!problems.empty()) throw BadJob(std::move(problems));
  return rest;
}

// Instantiated in identity.cpp only: they need code for every setting.
extern template std::string picture_key(const JobSpec& job);
extern template std::string preparation_key(const JobSpec& job);
extern template JobSpec without(const JobSpec& job, KeyList left_out);

}  // namespace lacuna
