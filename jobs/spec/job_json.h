#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "jobs/spec/job_spec.h"

namespace lacuna {

/// Size limit of a job file, in bytes, and nesting limit of its JSON.
inline constexpr std::size_t max_job_bytes = 1 << 20;
inline constexpr int max_json_depth = 32;

/// Parses and validates a job file. Defaults are filled in. Throws BadJob with every problem found:
/// malformed JSON (with line and column), nesting, unknown keys (with the nearest known one),
/// duplicate keys, wrong types, values out of range, missing keys, and conflicts between fields (an
/// error target whose metric needs a missing reference; duplicate layers; layers that the
/// integrator does not have; a shard beyond their number). Reads no other file.
JobSpec parse_job(std::string_view json);

/// The job with every default filled in, keys in the order of the tables, two spaces of indent.
/// parse_job(write_job(s)) == s.
std::string write_job(const JobSpec& spec);

/// The largest number of shards of a job with this number of iterations: each gets at least one
/// pair.
std::int64_t most_shards(std::int64_t iterations);

/// JSON Schema 2020-12 of the job file, made from the settings tables.
std::string job_schema();

/// JSON Schema 2020-12 of the sweep file.
std::string sweep_schema();

/// JSON Schema 2020-12 of a figure's file.
std::string figure_schema();

/// The settings pages (Markdown), made from the settings tables: every key, type, range, default,
/// unit.
std::string job_documentation();
std::string sweep_documentation();
std::string figure_documentation();

}  // namespace lacuna
