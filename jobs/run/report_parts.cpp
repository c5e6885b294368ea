#include "jobs/run/report_parts.h"

#include <unistd.h>

#include <cmath>

#include "base/storage/peak_memory.h"
#include "jobs/store/machine.h"

namespace lacuna {

OrderedJson reference_json(const Reference& reference, bool at_floor) {
  return {
      {"name", reference.name},
      {"file", std::filesystem::absolute(reference.file).string()},
      {"own_rmse", reference.mse ? OrderedJson(std::sqrt(*reference.mse)) : OrderedJson(nullptr)},
      {"at_floor", at_floor}};
}

OrderedJson machine_json(int threads, const std::optional<Disturbance>& disturbance) {
  OrderedJson j{{"processor", processor_name()},
                {"cores", sysconf(_SC_NPROCESSORS_ONLN)},
                {"threads", threads},
                {"peak_memory_bytes", peak_memory()}};
  if (disturbance) {
    j["others_share"] = disturbance->others;
    j["stolen_share"] = disturbance->stolen;
    j["load"] = disturbance->load;
    j["mhz"] = number_or_null(disturbance->mhz);
  }
  return j;
}

}  // namespace lacuna
