#pragma once

#include <cstdint>
#include <string>
#include <variant>

#include "jobs/spec/identity.h"

namespace lacuna {

/// The path lengths shared by all methods that estimate light, as a settings table.
struct LightLengths : PathLengths {};
template <class V>
void describe(V& v, LightLengths& s) {
  describe_lengths(v, s);
}

/// The integrator for a reference, which converges to the same picture. It is the same for all
/// integrators that estimate light, so that they can be compared: the most robust one. It has the
/// path lengths of `integrator`, except those of `not_in_the_light`.
JobIntegrator reference_integrator(const JobIntegrator& integrator);

/// The seed of references, so that a reference and a job share no random numbers.
inline constexpr std::uint64_t reference_seed = 0x726566657265;  // below 2^53, the largest seed

/// The job that renders the "auto" reference of `job`: the same except for the keys
/// `not_in_a_reference`, which get other values.
template <std::derived_from<JobSpec> Job>
Job reference_spec(const Job& job) {
  Job r = without(job, not_in_a_reference);
  r.label = "reference";
  r.integrator = reference_integrator(job.integrator);
  r.budget.iterations = job.reference_iterations;
  r.reference.clear();
  // Light does not depend on the analysis; some false colours do, as a guide's density may.
  if (const auto* s = std::get_if<InspectSettings>(&job.integrator)) {
    const bool analysed = shows_space(s->show) || shows_guide(s->show);
    if (analysed) r.analysis = job.analysis;
  }
  r.seed = reference_seed;
  r.threads = job.threads;
  r.layers = {ImageLayer::variance, ImageLayer::halves};
  return r;
}

/// Identifies the picture that a job's error is measured against: only errors of jobs with the same
/// result can be compared. With a named reference, path lengths belong to the method: they trade
/// bias for speed.
template <std::derived_from<JobSpec> Job>
std::string picture_name(const Job& job) {
  if (job.reference.empty() || job.reference == "auto") return picture_key(reference_spec(job));
  return hash_without(ObjectWriter::value_of(job), not_in_a_reference);
}

// Instantiated in reference_spec.cpp only: they need code for every setting.
extern template JobSpec reference_spec(const JobSpec& job);
extern template std::string picture_name(const JobSpec& job);

}  // namespace lacuna
