#include "jobs/spec/identity.h"

#include <fmt/format.h>
#include <xxhash.h>

namespace lacuna {

std::string hash_without(OrderedJson job, KeyList left_out) {
  for (const std::string_view key : left_out) job.erase(std::string(key));
  const std::string canonical = json_text(job, Escape::all_but_ascii);
  const XXH128_hash_t hash = XXH3_128bits(canonical.data(), canonical.size());
  return fmt::format("{:016x}{:016x}", hash.high64, hash.low64);
}

template std::string picture_key(const JobSpec& job);
template std::string preparation_key(const JobSpec& job);
template JobSpec without(const JobSpec& job, KeyList left_out);

}  // namespace lacuna
