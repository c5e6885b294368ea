#include "jobs/spec/job_json.h"

#include <optional>

#include "jobs/spec/identity.h"
#include "jobs/spec/problems.h"
#include "tests/fuzz/expect.h"
#include "tests/fuzz/target.h"

// A job file: refused with its problems, or a job that is written and read back without a change.

namespace lacuna::fuzz {
namespace {

std::optional<JobSpec> parse(std::string_view text) {
  try {
    return parse_job(text);
  } catch (const BadJob& bad) {
    expect(!bad.problems().empty(), "a job that is refused has a problem");
    return std::nullopt;
  }
}

}  // namespace
}  // namespace lacuna::fuzz

LACUNA_FUZZ_TARGET(job_json) {
  using namespace lacuna;
  const auto spec = fuzz::parse({reinterpret_cast<const char*>(data), size});
  if (!spec) return 0;
  const std::string text = write_job(*spec);
  const JobSpec again = parse_job(text);
  fuzz::expect(again == *spec, "a job that is written reads back equal");
  fuzz::expect(write_job(again) == text, "writing it again gives the same text");
  fuzz::expect(picture_key(again) == picture_key(*spec), "both make the same picture");
  return 0;
}
