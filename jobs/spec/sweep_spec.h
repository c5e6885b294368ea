#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "base/settings/field.h"
#include "jobs/spec/json_value.h"
#include "renderer/settings/error_metrics.h"

namespace lacuna {

/// The order of the runs of a sweep.
enum class SweepOrder { interleave, sequence };

template <>
struct EnumTable<SweepOrder> {
  static constexpr std::array<EnumValue<SweepOrder>, 2> values{{
      {SweepOrder::interleave, "interleave",
       "every cell with its first seed, then every cell with its second: background load affects "
       "all cells equally"},
      {SweepOrder::sequence, "sequence", "every seed of a cell, then the next cell"},
  }};
};

/// Which of a curve's two clocks is used.
enum class SweepClock { seconds, cpu_seconds };

template <>
struct EnumTable<SweepClock> {
  static constexpr std::array<EnumValue<SweepClock>, 2> values{{
      {SweepClock::seconds, "seconds", "render time, wall clock"},
      {SweepClock::cpu_seconds, "cpu_seconds",
       "CPU seconds divided by threads: unaffected by other load on the machine"},
  }};
};

/// The times and errors at which the cells of a sweep are compared.
struct CompareAt {
  std::vector<double> seconds, errors;
  std::optional<ErrorMetric> metric;
  SweepClock clock = SweepClock::seconds;
  bool operator==(const CompareAt&) const = default;
};
template <class V>
void describe(V& v, CompareAt& s) {
  v("seconds", s.seconds,
    {.doc = "render times at which errors are compared; none: the last time that all cells reach, "
            "and 1/2, 1/4 and 1/10 of it",
     .max = 16});
  v("errors", s.errors,
    {.doc = "errors for which times are compared; none: the smallest error that all cells reach, "
            "and twice that",
     .max = 16});
  v("metric", s.metric, {.doc = "the error metric; none: relmse, or est_rmse without a reference"});
  v("clock", s.clock, {.doc = "the clock of render times"});
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
  v("label", s.label, {.doc = "a description of your own", .max = 200});
  v("job", s.job,
    {.doc = "the job file that all runs share; settings of axes may be missing", .required = true});
  v("axes", s.axes,
    {.doc = "settings and their values; all combinations are run: "
            "{\"/integrator/max_depth\": [4, 8]}",
     .max = 16});
  v("zip", s.zip,
    {.doc = "settings that vary together as one axis: lists of equal length, for example scenes "
            "and their cameras",
     .max = 16});
  v("exclude", s.exclude,
    {.doc = "combinations to leave out: all cells with all values of an entry", .max = 1000});
  v("seeds", s.seeds,
    {.doc = "runs of each cell, with the job's seed and the following seeds",
     .min = 1,
     .max = 1000});
  v("baseline", s.baseline,
    {.doc = "values of the baseline: each cell is compared with the cell that has these values and "
            "otherwise equal ones",
     .max = 16});
  v("compare_at", s.compare_at, {.doc = "times and errors at which cells are compared"});
  v("order", s.order, {.doc = "order of the runs"});
  v("alone", s.alone,
    {.doc = "one run at a time on the machine, so that times can be compared; false: as many at a "
            "time as the service or --jobs allows"});
}

}  // namespace lacuna
