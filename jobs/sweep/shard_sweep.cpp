#include "jobs/sweep/shard_sweep.h"

#include <fmt/format.h>

#include "jobs/spec/described_json.h"
#include "jobs/spec/job_json.h"

namespace lacuna {

SweepSpec shard_sweep(const JobSpec& job) {
  SweepSpec sweep;
  sweep.label = job.label.empty() ? "shards" : job.label;
  sweep.job.text = json_text(parse_own(write_job(job)));
  std::vector<JsonValue>& numbers = sweep.axes["/shard"];
  for (int k = 1; k <= job.shards; ++k) numbers.push_back({fmt::format("{}", k)});
  sweep.alone = false;
  sweep.order = SweepOrder::sequence;
  return sweep;
}

}  // namespace lacuna
