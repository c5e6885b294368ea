#include "server/routes/cache_listing.h"

#include <sys/stat.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "analysis/artefacts/cache_folder.h"

namespace lacuna {
namespace {

namespace fs = std::filesystem;
using std::chrono::system_clock;

/// `bytes` and `used` first, for sorting.
struct Entry {
  std::uint64_t bytes = 0;
  system_clock::time_point used;
  OrderedJson json;
};

Entry entry_of(const char* kind, const std::string& name, std::uint64_t bytes,
               system_clock::time_point used) {
  return {
      bytes, used, {{"kind", kind}, {"name", name}, {"bytes", bytes}, {"used", utc_text(used)}}};
}

/// The regular files in a reference's folder, or its single file.
Entry reference_entry(const fs::path& path) {
  std::uint64_t bytes = 0;
  std::time_t used = 0;
  const auto add = [&](const fs::path& file) {
    struct stat status {};
    if (::lstat(file.c_str(), &status) != 0 || !S_ISREG(status.st_mode)) return;
    bytes += static_cast<std::uint64_t>(status.st_size);
    used = std::max({used, status.st_mtim.tv_sec, status.st_atim.tv_sec});
  };
  add(path);
  std::error_code gone;  // files may change meanwhile
  if (fs::is_directory(fs::symlink_status(path, gone))) {
    for (const auto& part : fs::recursive_directory_iterator(path, gone)) add(part.path());
  }
  return entry_of("reference", path.filename().string(), bytes, system_clock::from_time_t(used));
}

Entry artefact_entry(const CacheEntry& artefact) {
  const std::string& name = artefact.refusal ? "?" : artefact.header.type;
  Entry entry = entry_of("artefact", name, artefact.bytes, artefact.used);
  entry.json["file"] = artefact.file.filename().string();
  if (artefact.refusal) {
    entry.json["refused"] = artefact.refusal->text;
  } else {
    entry.json["key"] = artefact.header.key;
    entry.json["label"] = artefact.header.label;
  }
  return entry;
}

}  // namespace

OrderedJson cache_listing(const DataRoot& data) {
  std::vector<Entry> entries;
  std::error_code gone;
  for (const auto& item : fs::directory_iterator(data.references(), gone)) {
    // Hidden files are unfinished.
    if (item.path().filename().string().starts_with('.')) continue;
    entries.push_back(reference_entry(item.path()));
  }
  for (const CacheEntry& artefact : list_cache(data.cache(), CacheCheck::headers)) {
    entries.push_back(artefact_entry(artefact));
  }
  std::stable_sort(entries.begin(), entries.end(),
                   [](const Entry& a, const Entry& b) { return a.bytes > b.bytes; });
  std::uint64_t bytes = 0;
  auto list = OrderedJson::array();
  for (Entry& e : entries) {
    bytes += e.bytes;
    list.push_back(std::move(e.json));
  }
  return {{"bytes", bytes}, {"entries", std::move(list)}};
}

}  // namespace lacuna
