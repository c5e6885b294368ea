#include "server/catalogue.h"

#include <fmt/format.h>
#include <sys/stat.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <variant>
#include <vector>

#include "jobs/spec/job_json.h"
#include "server/message.h"

namespace lacuna {
namespace {

/// A regular file's size; nothing for what is not there or is something else.
std::optional<std::int64_t> size_of(const std::filesystem::path& file) {
  struct stat status {};
  if (::lstat(file.c_str(), &status) != 0 || !S_ISREG(status.st_mode)) return std::nullopt;
  return status.st_size;
}

Json files_of(const JobFolder& folder) {
  Json files = Json::array();
  for (const FileInfo& info : job_files()) {
    if (!info.served) continue;
    if (const auto bytes = size_of(folder.file(info.name))) {
      files.push_back({{"name", info.name}, {"bytes", *bytes}, {"media_type", info.media_type}});
    }
  }
  return files;
}

template <class T>
Json or_null(const std::optional<T>& value) {
  return value ? Json(*value) : Json(nullptr);
}

}  // namespace

Json to_json(const JobState& s) {
  return {{"state", enum_name(s.state)}, {"phase", s.phase},     {"attempts", s.attempts},
          {"exit_code", s.exit_code},    {"created", s.created}, {"started", s.started},
          {"finished", s.finished},      {"error", s.error},     {"warnings", s.warnings}};
}

Json to_json(const Progress& p) {
  return {{"iteration", p.iteration},
          {"seconds", p.seconds},
          {"cpu_seconds", p.cpu_seconds},
          {"share", p.share},
          {"remaining_seconds", or_null(p.remaining_seconds)},
          {"error", or_null(p.error)},
          {"error_metric", p.error_metric}};
}

JobFolder Catalogue::find(const std::string& id) const {
  JobFolder folder(data_.jobs() / id);
  if (!is_job_id(id) || !size_of(folder.file("job.json"))) {
    throw HttpError(404, fmt::format("There is no job \"{}\".", id));
  }
  return folder;
}

Catalogue::Known Catalogue::known(const JobFolder& folder) const {
  Known known;
  bool is_known = false;
  {
    const std::lock_guard lock(mutex_);
    const auto found = known_.find(folder.id());
    is_known = found != known_.end();
    if (is_known) known = found->second;
  }
  if (known.over) return known;
  if (!is_known) {
    const JobSpec spec = folder.read_job();
    known.label = spec.label;
    known.scene = spec.scene;
    known.integrator =
        std::visit([](const auto& s) { return std::string(s.name); }, spec.integrator);
  }
  const bool held = queue_.holds(folder);
  known.state = queue_.state(folder);
  known.progress = folder.read_progress();
  known.over = !held && is_terminal(known.state.state);
  const std::lock_guard lock(mutex_);
  known_[folder.id()] = known;
  return known;
}

Json Catalogue::list() const {
  std::vector<Json> jobs;
  for (const JobFolder& folder : list_jobs(data_.jobs())) {
    Json entry = {{"id", folder.id()}};
    try {
      const Known job = known(folder);
      entry.update({{"label", job.label}, {"scene", job.scene}, {"integrator", job.integrator}});
      entry.update(to_json(job.state));
      entry["progress"] = job.progress ? to_json(*job.progress) : Json(nullptr);
    } catch (const std::exception& error) {  // a damaged folder hides no other job
      entry.update({{"label", ""}, {"scene", ""}, {"integrator", ""}});
      JobState damaged;
      damaged.state = State::failed;
      damaged.error = fmt::format("the job's folder cannot be read: {}", error.what());
      entry.update(to_json(damaged));
      entry["progress"] = nullptr;
    }
    jobs.push_back(std::move(entry));
  }
  // Ids tell the order only to a second.
  std::reverse(jobs.begin(), jobs.end());
  std::stable_sort(jobs.begin(), jobs.end(),
                   [](const Json& a, const Json& b) { return a["created"] > b["created"]; });
  return {{"jobs", std::move(jobs)}};
}

Json Catalogue::detail(const JobFolder& folder) const {
  const JobState state = queue_.state(folder);
  const auto progress = folder.read_progress();
  return {{"id", folder.id()},
          {"job", Json::parse(write_job(folder.read_job()))},
          {"state", to_json(state)},
          {"progress", progress ? to_json(*progress) : Json(nullptr)},
          {"files", files_of(folder)}};
}

}  // namespace lacuna
