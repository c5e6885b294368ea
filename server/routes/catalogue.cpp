#include "server/routes/catalogue.h"

#include <fmt/format.h>
#include <sys/stat.h>

#include <nlohmann/json.hpp>

#include "jobs/spec/job_json.h"
#include "server/http/message.h"

namespace lacuna {
namespace {

/// A regular file's size; nothing for what is not there or is something else.
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

OrderedJson or_null(const std::string& text) {
  return text.empty() ? OrderedJson(nullptr) : OrderedJson(text);
}

}  // namespace

EntryPtr find_job(JobTable& table, const std::string& id) {
  EntryPtr entry = is_job_id(id) ? table.find(id) : nullptr;
  if (!entry || !is_job(table.folder(id))) {
    throw HttpError(404, fmt::format("There is no job \"{}\".", id));
  }
  return entry;
}

OrderedJson counts_json(const JobTable::Counts& counts) {
  OrderedJson json = OrderedJson::object();
  for (const auto& [state, name, doc] : EnumTable<State>::values) {
    const auto found = counts.find(state);
    json[std::string(name)] = found == counts.end() ? 0 : found->second;
  }
  return json;
}

std::string list_text(const JobTable::Page& page) {
  std::string text = "{\"jobs\":[";
  for (const EntryPtr& entry : page.jobs) {
    if (text.back() != '[') text += ',';
    text += '\n';
    text += entry->text;
  }
  const OrderedJson counts = counts_json(page.counts);
  const OrderedJson next = page.next.empty() ? OrderedJson(nullptr) : OrderedJson(page.next);
  return text + fmt::format("],\n\"total\":{},\"counts\":{},\"next\":{},\"last_event\":{}}}\n",
                            page.total, json_text(counts), json_text(next),
                            json_text(OrderedJson(page.last_event)));
}

OrderedJson job_detail(const JobTable& table, const JobEntry& entry) {
  const JobFolder folder = table.folder(entry.id);
  OrderedJson job = nullptr, state = state_json(entry);
  try {
    job = parse_own(write_job(folder.read_job()));
  } catch (const BadJob& bad) {  // it was damaged after it had been read, unless the state says so
    if (!entry.damaged) state["error"] = fmt::format("job.json cannot be read: {}", bad.what());
  }
  return {{"id", entry.id},
          {"sweep", sweep_json(entry)},
          {"shards", or_null(entry.control.shards)},
          {"job", std::move(job)},
          {"state", std::move(state)},
          {"progress", entry.progress ? to_json(*entry.progress) : OrderedJson(nullptr)},
          {"priority", entry.control.priority},
          {"held", entry.control.held},
          {"files", files_of(folder)}};
}

}  // namespace lacuna
