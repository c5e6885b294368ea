#pragma once

#include "jobs/spec/job_spec.h"

namespace lacuna {

/// The job that makes the "auto" reference of `spec`: the plain, unbiased integrator of the same
/// picture (light transport, pixel filter), with random numbers of its own.
JobSpec reference_spec(const JobSpec& spec);

/// Names what a job's error is measured against. Jobs of one text estimate one picture: only their
/// errors can be compared.
std::string picture_name(const JobSpec& spec);

}  // namespace lacuna
