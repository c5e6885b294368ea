#pragma once

#include <array>
#include <string>
#include <vector>

#include "analysis/settings/field.h"
#include "jobs/spec/json_value.h"

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
  SweepOrder order = SweepOrder::interleave;
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
  v("order", s.order, {.doc = "in which order runs are done"});
}

}  // namespace lacuna
