#pragma once

#include <cstdint>
#include <string>
#include <variant>

#include "jobs/spec/identity.h"

namespace lacuna {

/// The path lengths that all methods of light share, as a table of their own.
struct LightLengths : PathLengths {};
template <class V>
void describe(V& v, LightLengths& s) {
  describe_lengths(v, s);
}

/// The integrator that a reference is made with: converges to the same picture. For all that
/// measure light it is one and the same, so that they can be compared, and the one that the fewest
/// scenes defeat. Has the path lengths of `integrator` but for `not_in_the_light`.
IntegratorSettings reference_integrator(const IntegratorSettings& integrator);

/// The seed of references: no random number of one is the job's own.
inline constexpr std::uint64_t reference_seed = 0x726566657265;  // below 2^53, the largest seed

/// The job that makes the "auto" reference of `job`: the same but for the keys
/// `not_in_a_reference`, of which a reference has its own.
template <std::derived_from<JobSpec> Job>
Job reference_spec(const Job& job) {
  Job r = without(job, not_in_a_reference);
  r.label = "reference";
  r.integrator = reference_integrator(job.integrator);
  r.budget.iterations = job.reference_iterations;
  r.reference.clear();
  // Light does not depend on the analysis; some false colours do, as a guide's density may.
  if (const auto* s = std::get_if<InspectSettings>(&job.integrator)) {
    const bool analysed = shows_space(s->show) || s->show == InspectQuantity::guide_density;
    if (analysed) r.analysis = job.analysis;
  }
  r.seed = reference_seed;
  r.threads = job.threads;
  r.layers = {ImageLayer::variance, ImageLayer::halves};
  return r;
}

/// Names what a job's error is measured against. Jobs of one text estimate one picture: only their
/// errors can be compared. Against a named reference, path lengths are part of the method: they
/// trade bias for speed.
template <std::derived_from<JobSpec> Job>
std::string picture_name(const Job& job) {
  if (job.reference.empty() || job.reference == "auto") return picture_key(reference_spec(job));
  return hash_without(ObjectWriter::value_of(job), not_in_a_reference);
}

}  // namespace lacuna
