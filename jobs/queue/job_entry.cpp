#include "jobs/queue/job_entry.h"

#include <variant>

#include "jobs/spec/job_json.h"

namespace lacuna {

void take_spec(JobEntry& entry, const JobSpec& spec) {
  entry.label = spec.label;
  entry.scene = spec.scene;
  entry.integrator = std::visit([](const auto& s) { return std::string(s.name); }, spec.integrator);
  entry.reference = spec.reference;
  entry.exclusive = spec.exclusive;
  entry.spec = write_job(spec);
}

bool has_picture(const JobFolder& folder) {
  std::error_code unknown;
  return std::filesystem::exists(folder.file("image.png"), unknown);
}

}  // namespace lacuna
