#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "analysis/settings/field.h"
#include "jobs/spec/json_value.h"
#include "renderer/settings/error_metrics.h"

namespace lacuna {

/// In which order the runs of a sweep are done.
enum class SweepOrder { interleave, sequence };

template <>
struct EnumTable<SweepOrder> {
  static constexpr std::array<EnumValue<SweepOrder>, 2> values{{
      {SweepOrder::interleave, "interleave",
       "every cell with its first seed, then every cell with its second: what the machine does "
       "meanwhile meets all alike"},
      {SweepOrder::sequence, "sequence", "every seed of a cell, then the next cell"},
  }};
};

/// Which of a curve's two clocks counts.
enum class SweepClock { seconds, cpu_seconds };

template <>
struct EnumTable<SweepClock> {
  static constexpr std::array<EnumValue<SweepClock>, 2> values{{
      {SweepClock::seconds, "seconds", "render time, wall clock"},
      {SweepClock::cpu_seconds, "cpu_seconds",
       "CPU seconds divided by threads: holds still on a busy machine"},
  }};
};

/// Where the cells of a sweep are compared.
struct CompareAt {
  std::vector<double> seconds, errors;
  std::optional<ErrorMetric> metric;
  SweepClock clock = SweepClock::seconds;
  bool operator==(const CompareAt&) const = default;
};
template <class V>
void describe(V& v, CompareAt& s) {
  v("seconds", s.seconds,
    {.doc = "render times at which errors are compared; none: the last that all cells reach, and "
            "a half, a quarter and a tenth of it",
     .max = 16});
  v("errors", s.errors,
    {.doc = "errors to which times are compared; none: the smallest that all cells reach, and "
            "twice that",
     .max = 16});
  v("metric", s.metric,
    {.doc = "which error; none: relmse, or est_rmse where there is no reference"});
  v("clock", s.clock, {.doc = "which time"});
}

/// Many jobs that differ in some settings: the sweep file. Settings are named by JSON pointers (RFC
/// 6901) into the job.
struct SweepSpec {
  std::string label;
  JsonValue job{"{}"};
  JsonTable<std::vector<JsonValue>> axes;
  std::vector<JsonTable<std::vector<JsonValue>>> zip;
  std::vector<JsonTable<JsonValue>> exclude;
  int seeds = 1;
  JsonTable<JsonValue> baseline;
  CompareAt compare_at;
  SweepOrder order = SweepOrder::interleave;
  bool alone = true;
  bool operator==(const SweepSpec&) const = default;
};
template <class V>
void describe(V& v, SweepSpec& s) {
  v("label", s.label, {.doc = "a few words of your own", .max = 200});
  v("job", s.job,
    {.doc = "what all runs share: a job file, in which axes may be missing", .required = true});
  v("axes", s.axes,
    {.doc = "settings and the values that each takes, in every combination: "
            "{\"/integrator/max_depth\": [4, 8]}",
     .max = 16});
  v("zip", s.zip,
    {.doc = "settings that change together, as one axis: lists of equal length, as of a scene and "
            "its camera",
     .max = 16});
  v("exclude", s.exclude,
    {.doc = "combinations to leave out: all cells that have each of these values", .max = 1000});
  v("seeds", s.seeds,
    {.doc = "runs of each cell, which differ in their seed: the job's own, and those after it",
     .min = 1,
     .max = 1000});
  v("baseline", s.baseline,
    {.doc = "what is compared against: of every cell the one that has these values and else the "
            "same",
     .max = 16});
  v("compare_at", s.compare_at, {.doc = "where errors and times are compared"});
  v("order", s.order, {.doc = "in which order runs are done"});
  v("alone", s.alone,
    {.doc = "each run has the machine for itself, so that times can be compared; false: as many at "
            "a time as the service or --jobs allows"});
}

}  // namespace lacuna
