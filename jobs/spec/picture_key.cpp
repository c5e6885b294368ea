#include <fmt/format.h>
#include <xxhash.h>

#include <array>
#include <string_view>

#include "jobs/spec/job_json.h"
#include "jobs/spec/json_writer.h"

namespace lacuna {
namespace {

/// The keys of a job that do not touch the bits of its estimate after a given number of iterations.
/// Every other key does, or is taken to: a new key is part of the hash until it is listed here.
constexpr std::array<std::string_view, 9> not_in_the_picture{
    "label",                 // for people
    "budget",                // when to stop, not what is estimated
    "reference",             // what the estimate is compared with
    "reference_iterations",  // likewise
    "threads",               // random numbers are counted, not drawn
    "layers",                // filled beside the estimate; checkpoints tell theirs apart
    "pixel_type",            // rounds the file, not the film
    "checkpoint_seconds",    // when to save
    "exclusive"};            // what else runs meanwhile

}  // namespace

std::string picture_key(const JobSpec& spec) {
  OrderedJson decides = ObjectWriter::value_of(spec);
  for (const std::string_view key : not_in_the_picture) decides.erase(std::string(key));
  const std::string canonical = json_text(decides, Escape::all_but_ascii);
  const XXH128_hash_t hash = XXH3_128bits(canonical.data(), canonical.size());
  return fmt::format("{:016x}{:016x}", hash.high64, hash.low64);
}

}  // namespace lacuna
