#include "jobs/store/inputs.h"

#include <fmt/format.h>

#include <map>
#include <string_view>
#include <utility>

#include "jobs/spec/described_json.h"
#include "jobs/store/own_document.h"

namespace lacuna {
namespace {

constexpr const char* inputs_file = "inputs.json";

/// inputs.json.
struct InputRecord {
  InputList files;
};
template <class V>
void describe(V& v, InputRecord& s) {
  v("files", s.files, {.doc = "the input files of the job", .required = true});
}

/// How a file has changed; empty: not.
std::string change_of(const InputFile& before, const InputFile& now) {
  if (now.hash == before.hash && now.bytes == before.bytes) return "";
  if (now.bytes != before.bytes && (now.bytes > 0 || !now.hash.empty())) {
    return fmt::format("has {} bytes, and had {}", now.bytes, before.bytes);
  }
  return now.hash.empty() ? "no longer exists" : "has changed contents of the same size";
}

}  // namespace

std::optional<InputList> read_inputs(const JobFolder& folder) {
  const auto file = folder.file(inputs_file);
  std::error_code unknown;
  if (!std::filesystem::exists(file, unknown) && !unknown) return std::nullopt;
  return read_own<InputRecord>(file, {std::size_t{1} << 28, 8}).files;
}

void write_inputs(const JobFolder& folder, const InputList& inputs) {
  write_file_atomically(folder.file(inputs_file), write_document(InputRecord{inputs}));
}

std::string input_text(const InputFile& file) {
  return fmt::format("{} \"{}\"", enum_name(file.role), file.name);
}

std::vector<std::string> changed_inputs(const InputList& before, const InputList& now) {
  using Key = std::pair<InputRole, std::string_view>;
  std::map<Key, const InputFile*> found;
  for (const InputFile& file : now) found.emplace(Key{file.role, file.name}, &file);
  std::vector<std::string> changes;
  for (const InputFile& file : before) {
    const auto same = found.find(Key{file.role, file.name});
    if (same == found.end()) continue;
    const std::string change = change_of(file, *same->second);
    if (!change.empty()) changes.push_back(fmt::format("{} {}", input_text(file), change));
  }
  return changes;
}

}  // namespace lacuna
