#include "server/cache_listing.h"

#include <sys/stat.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace lacuna {
namespace {

namespace fs = std::filesystem;
using std::chrono::system_clock;

struct Entry {
  std::string kind, name;
  std::uint64_t bytes = 0;
  std::int64_t used = 0;  ///< seconds since 1970
};

void add_file(Entry& entry, const fs::path& file) {
  struct stat status {};
  if (::lstat(file.c_str(), &status) != 0 || !S_ISREG(status.st_mode)) return;
  entry.bytes += static_cast<std::uint64_t>(status.st_size);
  entry.used = std::max({entry.used, status.st_mtim.tv_sec, status.st_atim.tv_sec});
}

/// Each entry of `folder` with all that is below it; hidden ones are unfinished.
void add_entries(std::vector<Entry>& entries, const fs::path& folder, const std::string& kind) {
  std::error_code gone;  // entries come and go meanwhile
  for (const auto& item : fs::directory_iterator(folder, gone)) {
    Entry entry{kind, item.path().filename().string()};
    if (entry.name.starts_with('.')) continue;
    add_file(entry, item.path());
    if (fs::is_directory(item.symlink_status(gone))) {
      for (const auto& part : fs::recursive_directory_iterator(item, gone)) {
        add_file(entry, part.path());
      }
    }
    entries.push_back(std::move(entry));
  }
}

}  // namespace

nlohmann::ordered_json cache_listing(const DataRoot& data) {
  std::vector<Entry> entries;
  add_entries(entries, data.references(), "reference");
  add_entries(entries, data.cache(), "artefact");
  std::sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) {
    return std::pair(b.bytes, a.name) < std::pair(a.bytes, b.name);
  });
  std::uint64_t bytes = 0;
  auto list = nlohmann::ordered_json::array();
  for (const Entry& e : entries) {
    bytes += e.bytes;
    list.push_back({{"kind", e.kind},
                    {"name", e.name},
                    {"bytes", e.bytes},
                    {"used", utc_text(system_clock::from_time_t(e.used))}});
  }
  return {{"bytes", bytes}, {"entries", std::move(list)}};
}

}  // namespace lacuna
