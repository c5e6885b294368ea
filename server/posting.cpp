#include "server/posting.h"

#include <fmt/format.h>
#include <xxhash.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <system_error>
#include <utility>
#include <vector>

#include "jobs/spec/job_json.h"
#include "server/catalogue.h"
#include "server/conditional.h"
#include "server/json_body.h"
#include "server/log.h"

namespace lacuna {
namespace {

std::string hash128(const std::string& text) {
  const XXH128_hash_t h = XXH3_128bits(text.data(), text.size());
  return fmt::format("{:016x}{:016x}", h.high64, h.low64);
}

/// The header's value; throws HttpError 400 if it is no key.
std::optional<std::string> key_of(const Request& request) {
  constexpr std::size_t longest = 128;
  auto key = request.header("idempotency-key");
  const auto is_printable = [](unsigned char c) { return c > 0x20 && c < 0x7f; };
  if (key && (key->empty() || key->size() > longest ||
              !std::all_of(key->begin(), key->end(), is_printable))) {
    throw HttpError(400, "Header Idempotency-Key takes 1 to 128 printable characters, no spaces.");
  }
  return key;
}

}  // namespace

Response Posting::dry_run(const Request& request) const {
  const JobSpec spec = checked_spec(read_json_body(request, max_job_bytes));
  return json_response(200,
                       {{"job", parse_own(write_job(spec))}, {"warnings", OrderedJson::array()}});
}

Response Posting::post(const Request& request) {
  const auto key = key_of(request);
  const std::string body = read_json_body(request, max_job_bytes);
  JobControl control;
  if (!key) return create(checked_spec(body), control);

  control.idempotency_key = *key;
  control.body_hash = hash128(body);
  const std::lock_guard lock(mutex_);
  read_keys();
  const auto known = keys_.find(*key);
  if (known != keys_.end() && table_.find(known->second)) {
    return replay(known->second, control.body_hash);
  }
  return create(checked_spec(body), control);
}

/// Of the jobs that are there from before the service's start.
void Posting::read_keys() {
  if (std::exchange(keys_read_, true)) return;
  for (const EntryPtr& job : table_.all()) {
    if (!job->control.idempotency_key.empty()) keys_[job->control.idempotency_key] = job->id;
  }
}

Response Posting::replay(const std::string& id, const std::string& body_hash) const {
  const EntryPtr entry = find_job(table_, id);
  if (entry->control.body_hash != body_hash) {
    throw HttpError(422,
                    fmt::format("This Idempotency-Key stands for job {}, which was posted with "
                                "another body.",
                                id));
  }
  Response response = json_response(200, job_detail(table_, *entry));
  response.headers.emplace_back("Location", "/api/jobs/" + id);
  response.headers.emplace_back("Idempotent-Replayed", "true");
  return response;
}

Response Posting::create(const JobSpec& spec, const JobControl& control) {
  try {
    queue_.check_room();
  } catch (const Full& full) {
    throw HttpError(429, full.what()).with("Retry-After", "10");
  }
  const JobFolder folder = [&] {
    try {
      return JobFolder::create(data_.jobs() / new_job_id(), spec, control);
    } catch (const std::system_error& error) {
      log::error("a job could not be stored: {}", error.what());
      throw HttpError(507, fmt::format("The job could not be stored: {}.", error.code().message()));
    }
  }();
  const std::string id = folder.id();
  if (!control.idempotency_key.empty()) keys_[control.idempotency_key] = id;
  const EntryPtr entry = queue_.add(id);
  log::info("{}: queued ({})", id, spec.scene);
  Response response = json_response(201, job_detail(table_, *entry));
  response.headers.emplace_back("Location", "/api/jobs/" + id);
  return response;
}

JobSpec Posting::checked_spec(const std::string& body) const {
  try {
    JobSpec spec = parse_job(body);
    check_files(spec);
    return spec;
  } catch (const BadJob& bad) {
    throw HttpError(400, "The job is not valid.", bad.problems());
  }
}

/// What the job names must be there before it is taken.
void Posting::check_files(const JobSpec& spec) const {
  std::vector<Problem> problems;
  const auto check = [&](const std::string& name, const std::vector<std::string_view>& extensions,
                         const char* pointer) {
    try {
      scenes_.resolve(name, extensions);
    } catch (const std::invalid_argument& error) {
      problems.push_back({pointer, error.what()});
    }
  };
  check(spec.scene, {".glb", ".gltf"}, "/scene");
  if (spec.environment) check(spec.environment->file, {".exr", ".hdr"}, "/environment/file");
  if (!problems.empty()) throw HttpError(400, "The job names a file that is not there.", problems);
}

}  // namespace lacuna
