#include "server/routes/catalogue.h"

#include <fmt/format.h>
#include <sys/stat.h>

#include <nlohmann/json.hpp>

#include "server/http/message.h"

namespace lacuna {
namespace {

/// A regular file's size; none if there is no regular file.
std::optional<std::int64_t> size_of(const std::filesystem::path& file) {
  struct stat status {};
  if (::lstat(file.c_str(), &status) != 0 || !S_ISREG(status.st_mode)) return std::nullopt;
  return status.st_size;
}

OrderedJson files_of(const JobFolder& folder) {
  OrderedJson files = OrderedJson::array();
  for (const FileInfo& info : job_files()) {
    if (!info.served) continue;
    if (const auto bytes = size_of(folder.file(info.name))) {
      files.push_back({{"name", info.name}, {"bytes", *bytes}, {"media_type", info.media_type}});
    }
  }
  return files;
}

}  // namespace

JobEntry find_job(const Store& store, const std::string& id) {
  auto entry = is_job_id(id) ? store.find(id) : std::nullopt;
  if (!entry) throw HttpError(404, fmt::format("There is no job \"{}\".", id));
  return std::move(*entry);
}

OrderedJson counts_json(const Counts& counts) {
  OrderedJson json = OrderedJson::object();
  for (const auto& [state, name, doc] : EnumTable<State>::values) {
    const auto found = counts.find(state);
    json[std::string(name)] = found == counts.end() ? 0 : found->second;
  }
  return json;
}

OrderedJson list_json(const JobPage& page) {
  OrderedJson jobs = OrderedJson::array();
  for (const JobEntry& entry : page.jobs) jobs.push_back(to_json(entry));
  return {{"jobs", std::move(jobs)},
          {"total", page.total},
          {"counts", counts_json(page.counts)},
          {"next", or_null(page.next)},
          {"last_event", page.last_event}};
}

OrderedJson job_detail(const JobFolder& folder, const JobEntry& entry) {
  return {{"id", entry.id},
          {"sweep", or_null(entry.sweep)},
          {"shards", or_null(entry.shards)},
          {"job", entry.spec.empty() ? OrderedJson(nullptr) : parse_own(entry.spec)},
          {"state", state_json(entry)},
          {"progress", entry.progress ? to_json(*entry.progress) : OrderedJson(nullptr)},
          {"priority", entry.priority},
          {"held", entry.held},
          {"files", files_of(folder)}};
}

}  // namespace lacuna
